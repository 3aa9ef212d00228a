// SPDX-License-Identifier: Apache-2.0
#include "test/host/tools/formats/imported.hpp"

#include <gtest/gtest.h>

#include "coupler/map/loader/load.hpp"

namespace coupler::test {

std::string lines_of(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) text += to_string(diagnostic) + '\n';
  return text;
}

Imported::Imported(std::string_view format, std::string_view text, const formats::ImportOptions& options)
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

Imported::~Imported() = default;

std::string Imported::text(std::size_t i) const {
  if (i >= result.maps.size()) return "no map:\n" + said;
  const std::string& all = result.maps[i].text;
  return all.substr(all.find('\n') + 1);
}

}  // namespace coupler::test
