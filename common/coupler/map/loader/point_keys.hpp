// SPDX-License-Identifier: Apache-2.0
// The keys of a point: point_reader.cpp calls each of these. Each is in a file of its own.
#pragma once

#include "coupler/codec/format.hpp"
#include "coupler/map/loader/draft_point.hpp"
#include "coupler/map/loader/reader.hpp"
#include "coupler/map/map.hpp"
#include "coupler/map/point.hpp"

namespace coupler::loader {

/// The type of a register point and the keys that go with it. `order` is the map's; the point's own overrides
/// it.
void read_format(const Reader& reader, const Entry& point, codec::Order order, codec::Format& format,
                 Context& context);

/// `scale:`, a number or a map of gain and offset.
void read_scale(const Reader& reader, Point& point, Context& context);

/// The GPIO line of a coil or discrete input: `line: GPIO17`, `line: {chip: gpiochip0, offset: 17}` or
/// `line: {name: GPIO17}`. What the line is like (active_low, bias, drive, debounce) is said beside `line` or
/// inside it, not in both; what the node does with it (safe, initial) only beside it.
void read_line(const Reader& point, DraftPoint& draft, Context& context);

/// `iio:`, `pwm:` and the `safe:` of registers. The point's format, count and scale must be known.
void read_channel(const Reader& reader, DraftPoint& draft, Context& context);

/// `counter:` of a register that holds a whole number of 16, 32 or 64 bits; `latched:` of a coil without a
/// line or a bit of a holding register. Comes after type, access and line.
void read_edges(const Reader& point, DraftPoint& draft, Context& context);

/// What they name is a discrete input that can have edges: wired, or at the end of a simulated wire.
void check_edges(const DraftPoints& points, Span<const SimWire> sim, Context& context);

/// A value of the point, given by `key` (`initial`, `safe`, …), as range(point).count() registers as they
/// stand on the wire. A scaled point's is written as it is published. An array takes a list, or one value for
/// all of its elements. Empty if it is wrong. The point's format, count and scale must be known.
Span<const std::uint16_t> read_value(std::string_view key, const Entry& entry, const Point& point,
                                     Context& context);

}  // namespace coupler::loader
