// SPDX-License-Identifier: Apache-2.0
// What a map must keep beyond each key by itself. Names have a file of their own.
#pragma once

#include "coupler/map/loader/draft_point.hpp"
#include "coupler/map/loader/placement.hpp"
#include "coupler/map/loader/reader.hpp"
#include "coupler/map/map.hpp"

namespace coupler::loader {

/// A GPIO line belongs to one point.
void check_lines(const DraftPoints& points, const Context& context);

/// Returns how many bits or registers of the table one request may read.
std::uint16_t most_in_a_read(Table table, const Limits& limits);

/// A point is read and written in one request, so it fits into the device's limits.
void check_sizes(const DraftPoints& points, const Limits& limits, const Context& context);

/// One warning for a map without `addressing` whose addresses mostly look like Modicon numbers.
void warn_of_modicon_numbers(const DraftPoints& points, const Context& context);

/// Points that share a bit. That is a warning when at most one of the two is writable and neither has a line,
/// otherwise an error; each point is reported once, against one that stands before it in the file.
void check_overlaps(const DraftPoints& points, const Context& context);

/// No point is read from an unreadable area, not even before it is written.
void check_unreadable(const Areas& areas, const DraftPoints& points, const Limits& limits,
                      const Context& context);

/// Areas that are read whole fit into a request, also with the points that reach beyond them. None overlaps
/// another one, or an unreadable area. `head` has the limits and the coupler's watchdog.
void check_whole_areas(const Areas& whole, const Areas& unreadable, const DraftPoints& points,
                       const Map& head, const Context& context);

/// To a broadcast points are written, and nothing is read. A tool's output is off, as the device has
/// acknowledged, before the other goes on; and the goal of an axis ends when its writes are acknowledged.
void check_broadcast(const Reader& top, const DraftPoints& points, const Map& head, const Context& context);

/// No point stands in a reserved area.
void check_reserved(const Areas& areas, const DraftPoints& points, const Context& context);

}  // namespace coupler::loader
