// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "common/formats/import.hpp"
#include "common/map/loader/load.hpp"

namespace coupler::test {

inline std::string lines_of(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) text += to_string(diagnostic) + '\n';
  return text;
}

/// What an importer makes of a text, and what the loader then makes of what it wrote.
struct Imported {
  Imported(std::string_view format, std::string_view text, const formats::ImportOptions& options = {})
      : result(formats::import_text(*formats::find_importer(format), text, "given", options)),
        said(lines_of(result.diagnostics)) {
    for (const formats::ImportedMap& map : result.maps) {
      const LoadResult loaded = load_map(map.text, "written");
      EXPECT_NE(loaded.map, nullptr) << lines_of(loaded.diagnostics) << map.text;
      if (loaded.map) {
        EXPECT_EQ(loaded.map->map().fingerprint, map.map->map().fingerprint) << map.text;
      }
    }
  }

  /// The written file, without its first line, which says where it comes from.
  std::string text(std::size_t i = 0) const {
    if (i >= result.maps.size()) return "no map:\n" + said;
    const std::string& all = result.maps[i].text;
    return all.substr(all.find('\n') + 1);
  }

  formats::ImportResult result;
  std::string said;
};

}  // namespace coupler::test
