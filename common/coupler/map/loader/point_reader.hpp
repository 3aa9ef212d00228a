// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/codec/format.hpp"
#include "coupler/map/allowed_values.hpp"
#include "coupler/map/loader/address.hpp"
#include "coupler/map/loader/draft_point.hpp"
#include "coupler/map/loader/reader.hpp"
#include "coupler/map/map.hpp"
#include "coupler/map/point.hpp"

namespace coupler::loader {

/// `defaults:` of the map, as far as it does not depend on a point.
struct HostDefaults {
  HostOptions options;
  const Entry* deadman = nullptr;  ///< its value is of each point's type
};
HostDefaults read_host_defaults(const Reader& top);

/// The keys at the top of the file that hold for all points.
struct PointDefaults {
  Addressing addressing = Addressing::zero_based;
  /// The order in values of two and four registers. In values of one register only the order of the bytes
  /// holds.
  codec::Order order = codec::Order::CDAB;
  HostDefaults host{};
};

// One entry of a table, `name: address` (coils and discrete inputs) or `name: {options}`, is read in two
// steps: points without an address get theirs in between.

/// Reads the properties that decide where the point may stand.
DraftPoint read_place(const Entry& entry, Table table, const PointDefaults& defaults, const Context& context);

/// Everything else. Values are read as they stand in their registers, so the place must be known.
void read_rest(const PointDefaults& defaults, DraftPoint& draft, const Context& context);

// The keys of a point, as read_place() and read_rest() read them.

/// How the host treats the point: its own keys, and the defaults that apply to it. Its access, and if it is
/// placed its format, count and scale must be known.
void read_host_options(const Reader& reader, const HostDefaults& defaults, DraftPoint& draft,
                       const Context& context);

/// The type of a register point and the keys that go with it. `order` is the map's; the point's own overrides
/// it.
void read_format(const Reader& reader, const Entry& point, codec::Order order, codec::Format& format,
                 const Context& context);

/// `type:`, by any of its names; must be given.
void read_type(const Reader& reader, codec::Type& type, const Context& context);

/// `scale:`, a number or a map of gain, offset and the point that holds its exponent.
void read_scale(const Reader& reader, Point& point, const Context& context);

/// `invalid:`, the raw values of a point of registers that mean that it has no value.
void read_invalid(const Reader& reader, Point& point, const Context& context);

/// `fault_below:` and `fault_above:`.
void read_faults(const Reader& reader, Point& point, const Context& context);

/// The points that `exponent_of` names must be whole numbers without a scale that are read.
void check_exponents(const DraftPoints& points, const Context& context);

/// `min:`, `max:`, `allow_nonfinite:` and `values:`. The point's format and scale must be known.
void read_allowed_values(const Reader& reader, Point& point, const Context& context);

/// An analogue output begins with `initial` and ends with `safe`, both 0 if not given: that must be allowed.
void check_start(const Reader& reader, const Point& point, const Context& context);

/// The GPIO line of a coil or discrete input: `line: GPIO17`, `line: {chip: gpiochip0, offset: 17}` or
/// `line: {name: GPIO17}`. The properties of the line (active_low, bias, drive, debounce) stand beside `line`
/// or inside it, not in both; what the node does with it (safe, initial) stands beside it.
void read_line(const Reader& point, DraftPoint& draft, const Context& context);

/// `iio:`, `pwm:` and the `safe:` of registers. The point's format, count and scale must be known.
void read_channel(const Reader& reader, DraftPoint& draft, const Context& context);

/// `counter:` of a register that holds a whole number of 16, 32 or 64 bits; `latched:` of a coil without a
/// line or a bit of a holding register. Comes after type, access and line.
void read_edges(const Reader& point, DraftPoint& draft, const Context& context);

/// `counter` and `latched` name a discrete input that has a line or is at the end of a simulated wire.
void check_edges(const DraftPoints& points, Span<const SimWire> sim, const Context& context);

/// A value of the point, given by `key` (`initial`, `safe`, …), as range(point).count() registers as they
/// stand on the wire. A scaled point's is written as it is published. An array takes a list, or one value for
/// all of its elements. Empty if it is wrong, or not allowed. The point's format, count, scale and allowed
/// values must be known.
Span<const std::uint16_t> read_value(std::string_view key, const Entry& entry, const Point& point,
                                     const Context& context);
/// The same, which the map does not keep.
std::vector<std::uint16_t> registers_of(std::string_view key, const Entry& entry, const Point& point,
                                        const Context& context);

}  // namespace coupler::loader
