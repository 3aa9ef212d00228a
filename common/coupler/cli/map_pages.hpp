// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/generate/generate.hpp"
#include "coupler/map/map.hpp"

namespace coupler::cli {

struct PagesRequest {
  std::string map;  ///< as the user named it; to "-", standard input, and to a node there are no links
  std::filesystem::path out;  ///< folder of the pages
  std::string name;           ///< of the files, as as_file_name() makes it
  std::string source;         ///< the map's file name, without its folder
  std::string source_url;     ///< folder of the map on a forge; empty: links are relative to `out`
};

/// NAME.html and NAME.md. `lines`: of the points, as LoadResult::point_lines.
std::vector<generate::File> map_pages(const PagesRequest& request, const Map& map, Span<const int> lines);

/// Without slashes: maps may be called hall/press.
std::string as_file_name(std::string name);

/// Nothing in it ends a URL in HTML or Markdown.
bool is_url_part(std::string_view text);

}  // namespace coupler::cli
