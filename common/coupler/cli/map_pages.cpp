// SPDX-License-Identifier: Apache-2.0
#include "coupler/cli/map_pages.hpp"

#include <algorithm>

#include "coupler/docs/escape.hpp"
#include "coupler/docs/document.hpp"
#include "coupler/map/node_address.hpp"

namespace coupler::cli {
namespace {

namespace fs = std::filesystem;

std::string url_of_map(const PagesRequest& request) {
  if (request.map == "-" || names_a_node(request.map)) return {};
  const fs::path map = fs::absolute(request.map).lexically_normal();
  if (request.source_url.empty())
    return docs::url_path(map.lexically_relative(fs::absolute(request.out).lexically_normal()).string());
  const bool ended = request.source_url.back() == '/';
  return request.source_url + (ended ? "" : "/") + docs::url_path(map.filename().string());
}

}  // namespace

std::vector<generate::File> map_pages(const PagesRequest& request, const Map& map, Span<const int> lines) {
  const auto document =
      docs::make_document(map, lines, {request.source, url_of_map(request), COUPLER_VERSION});
  const std::string name = as_file_name(request.name);
  return {{name + ".html", docs::html_page(document)}, {name + ".md", docs::markdown_page(document)}};
}

std::string as_file_name(std::string name) {
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

bool is_url_part(std::string_view text) {
  constexpr std::string_view refused = "<>\"\\^`{|}";
  return std::none_of(text.begin(), text.end(), [&](char c) {
    return (static_cast<unsigned char>(c) <= ' ') || refused.find(c) != std::string_view::npos;
  });
}

}  // namespace coupler::cli
