// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/named_write.hpp"

#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "coupler/host/core/value_text.hpp"
#include "coupler/map/nearest.hpp"
#include "coupler/map/printable.hpp"
#include "coupler/plan/explain.hpp"
#include "coupler/plan/planner.hpp"

namespace coupler::host {

tl::expected<const Point*, std::string> point_named(const Map& map, std::string_view name) {
  if (const Point* point = find(map, name)) return point;
  std::vector<std::string_view> names;
  names.reserve(map.points.size());
  for (const Point& point : map.points) names.push_back(point.name);
  return tl::unexpected(fmt::format("there is no point {} in the map of {}; {}", excerpt(name), map.name,
                                    nearest_or(name, names, "the map has their names")));
}

tl::expected<const Point*, std::string> read_point_named(const Map& map, std::string_view name) {
  auto point = point_named(map, name);
  if (!point) return point;
  if (const auto reason = plan::why_not_read(map, **point))
    return tl::unexpected(fmt::format("{} is never read: it is {}", (*point)->name, plan::words_of(*reason)));
  return point;
}

tl::expected<Write, std::string> write_named(const Map& map, std::string_view name, std::string_view text) {
  const auto point = point_named(map, name);
  if (!point) return tl::unexpected(point.error());
  if (!is_writable(**point))
    return tl::unexpected(fmt::format("{} cannot be written: {}", name,
                                      is_writable((*point)->table)
                                          ? "the map says 'access: read'"
                                          : "it is an input; coils and holding registers can be"));
  std::vector<std::uint16_t> value(range(**point).count());
  if (const auto parsed = parse_value(text, **point, value.data()); !parsed)
    return tl::unexpected(parsed.error());
  return make_write(map, static_cast<std::uint32_t>(*point - map.points.begin()), value);
}

}  // namespace coupler::host
