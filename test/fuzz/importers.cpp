// SPDX-License-Identifier: Apache-2.0
// Every importer on any text: it never throws, and what it writes is a map that the loader reads as the same
// one. The first byte chooses the format.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "coupler/map/loader/load.hpp"
#include "coupler/tools/formats/exporters.hpp"
#include "coupler/tools/formats/importers.hpp"
#include "test/fuzz/require.hpp"

namespace coupler::fuzz {
namespace {

void check(const formats::ImportedMap& imported) {
  const LoadResult loaded = load_map(imported.text, "written");
  require(loaded.map != nullptr, "what an importer writes is a map");
  const Map& map = loaded.map->map();
  require(map.fingerprint == imported.map->map().fingerprint, "it is the map that was imported");
  for (const formats::Exporter& exporter : formats::exporters())
    require(!exporter.write(map).text.empty(), "every map can be exported");
}

}  // namespace
}  // namespace coupler::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace coupler;
  if (size == 0) return 0;
  const auto importers = formats::importers();
  const formats::Importer& importer = importers[data[0] % importers.size()];
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  const formats::ImportResult result = formats::import_text(importer, text, "given", {});
  fuzz::require(result.maps.empty() == has_errors(result.diagnostics),
                "there are maps unless there are errors");
  for (const formats::ImportedMap& imported : result.maps) fuzz::check(imported);
  return 0;
}
