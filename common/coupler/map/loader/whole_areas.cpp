// SPDX-License-Identifier: Apache-2.0
// The key `read_whole`.
#include <algorithm>

#include <fmt/format.h>

#include "coupler/map/loader/rules.hpp"
#include "coupler/modbus/limits.hpp"

namespace coupler::loader {
namespace {

void check_others(const Area& area, const Area* begin, const Area* end, std::string_view key,
                  const Context& context) {
  const Area* const other = std::find_if(begin, end, [&](const Area& each) {
    return each.table == area.table && each.range.overlaps(area.range);
  });
  if (other == end) return;
  context.problems.error(area.at,
                         fmt::format("this area overlaps an area of '{}' (line {})", key, other->at.line),
                         key == "unreadable" ? "make one of them smaller"
                                             : "write one area for both, or make one of them smaller",
                         {{other->at, "the other area is here"}});
}

/// A request for a point asks for all areas that it touches.
void check_point(const DraftPoint& draft, const Areas& whole, const Limits& limits, const Context& context) {
  const Point& point = draft.point;
  const modbus::Range own = read_range(point);
  std::uint32_t start = own.start();
  std::uint32_t end = own.end();
  const Area* touched = nullptr;
  for (const Area& area : whole) {
    if (point.table != area.table || !own.overlaps(area.range)) continue;
    start = std::min<std::uint32_t>(start, area.range.start());
    end = std::max(end, area.range.end());
    touched = &area;
  }
  const std::uint32_t most = most_in_a_read(point.table, limits);
  if (touched == nullptr || end - start <= most) return;
  context.problems.error(draft.address_at,
                         fmt::format("{} reaches beyond an area of 'read_whole' (line {}): to read both "
                                     "takes {} addresses, and a request "
                                     "may ask for {}",
                                     shown(point.name), touched->at.line, end - start, most),
                         "end the area where the point begins or ends", {{touched->at, "the area is here"}});
}

/// Returns whether the host reads something in it for the coupler's watchdog. What it only writes does not
/// count.
bool has_watchdog(const Area& area, const WatchdogSequences& watchdog) {
  using Write = WatchdogSequences::Write;
  const auto is_here = [&area](const Write& place) {
    return place.table == area.table && area.range.contains(place.address);
  };
  const auto is_read_here = [&](const Write& step) { return step.if_different && is_here(step); };
  if (watchdog.alarm && is_here(*watchdog.alarm)) return true;
  return std::any_of(watchdog.arm.begin(), watchdog.arm.end(), is_read_here) ||
         std::any_of(watchdog.reset.begin(), watchdog.reset.end(), is_read_here);
}

}  // namespace

void check_whole_areas(const Areas& whole, const Areas& unreadable, const DraftPoints& points,
                       const Map& head, const Context& context) {
  const Limits& limits = head.limits;
  for (const Area& area : whole) {
    const std::uint32_t most = most_in_a_read(area.table, limits);
    if (area.range.count() > most)
      context.problems.error(
          area.at,
          fmt::format("this area has {} addresses, but a request may ask for {}", area.range.count(), most),
          most < modbus::max_read_registers || (holds_bits(area.table) && most < modbus::max_read_bits)
              ? fmt::format("make it smaller; the device's limit is 'limits: {{{}: ...}}'",
                            holds_bits(area.table) ? "read_bits" : "read_registers")
              : "make it smaller: no reply has room for more");
    if (!has_watchdog(area, head.coupler_watchdog) &&
        std::none_of(points.begin(), points.end(), [&](const DraftPoint& draft) {
          return draft.point.table == area.table && draft.placed &&
                 read_range(draft.point).overlaps(area.range);
        }))
      context.problems.warning(area.at, "no point is in this area of 'read_whole'",
                               "remove it, or correct its addresses");
    check_others(area, whole.data(), &area, "read_whole", context);
    check_others(area, unreadable.data(), unreadable.data() + unreadable.size(), "unreadable", context);
  }
  for (const DraftPoint& draft : points)
    if (draft.placed && needs_answers(draft.point, limits)) check_point(draft, whole, limits, context);
}

}  // namespace coupler::loader
