// SPDX-License-Identifier: Apache-2.0
// The map loader on any text: it never throws, and what it lets pass is a map that both sides can work with.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "coupler/map/diff.hpp"
#include "coupler/map/fingerprint.hpp"
#include "coupler/map/identity.hpp"
#include "coupler/map/loader/load.hpp"
#include "test/device/core/node_under_test.hpp"
#include "test/fuzz/require.hpp"

namespace coupler::fuzz {
namespace {

void check_diagnostics(const Diagnostics& diagnostics, std::string_view text) {
  const auto lines = 1 + std::count(text.begin(), text.end(), '\n');
  for (const Diagnostic& diagnostic : diagnostics) {
    require(diagnostic.line >= 0 && diagnostic.line <= lines, "a diagnostic is about a line of the file");
    require(diagnostic.column >= 0, "a column is not negative");
    require(!diagnostic.what.empty() && !diagnostic.remedy.empty(),
            "a diagnostic says what is wrong, and what to do");
  }
}

void check_points(const Map& map) {
  require(std::is_sorted(map.points.begin(), map.points.end(), canonical_less),
          "points are in canonical order");
  for (const Point& point : map.points) {
    require(find(map, point.name) == &point, "a name belongs to one point");
    require(point.initial.empty() || point.initial.size() == range(point).count(),
            "an initial value fills its point");
  }
}

/// Every point has its cells, unless a node would refuse the map for it.
void check_image(const Map& map) {
  const device::OwnedImage memory(map);
  for (const Point& point : map.points) {
    if (!holds_bits(point.table) && range(point).overlaps(identity::reserved)) return;
    require(memory.image.find(point.table, range(point)).size() == range(point).count(),
            "a point has its cells");
    require(memory.image.find_writable(point.table, range(point)).empty() || is_writable(point.table),
            "inputs are not written");
  }
}

}  // namespace
}  // namespace coupler::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace coupler;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const LoadResult loaded = load_map_with_lock(text, "map", {"map.lock", std::nullopt, LockUse::renew});
  fuzz::check_diagnostics(loaded.diagnostics, text);
  fuzz::require((loaded.map == nullptr) == has_errors(loaded.diagnostics),
                "there is a map unless there are errors");
  if (loaded.map == nullptr) return 0;

  const Map& map = loaded.map->map();
  fuzz::check_points(map);
  fuzz::check_image(map);
  const LoadResult again = load_map(map.text, "map");
  fuzz::require(again.map != nullptr, "the text that a node serves is a map");
  fuzz::require(again.map->map().fingerprint == map.fingerprint && diff(map, again.map->map()).empty(),
                "the text that a node serves is the same map");
  return 0;
}
