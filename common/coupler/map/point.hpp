// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "coupler/base/enumeration.hpp"
#include "coupler/base/span.hpp"
#include "coupler/codec/format.hpp"
#include "coupler/codec/scale.hpp"
#include "coupler/map/hardware.hpp"
#include "coupler/map/table.hpp"
#include "coupler/modbus/range.hpp"

namespace coupler {

/// How the host treats one point. It does not concern the coupler, so it is not in the fingerprint.
struct HostOptions {
  enum class Publish : std::uint8_t { always, on_change };
  /// The function codes that write it.
  enum class WriteFunction : std::uint8_t {
    automatic,  ///< 5 or 6 for one address, 15 or 16 for several
    single,     ///< 5 or 6 only: never merged with its neighbours
    multiple    ///< 15 or 16, also for one address
  };
  /// The effect of a new value on values of the same point that still wait to be sent.
  enum class WriteQueue : std::uint8_t {
    latest,  ///< replaces one that is last in the queue
    every    ///< every value is sent, by itself
  };
  /// The priority of a write among those that wait to be sent.
  enum class Priority : std::uint8_t {
    normal,
    high  ///< before all that are normal
  };
  /// After so long without a message the value is written.
  struct Deadman {
    std::chrono::milliseconds timeout{0};  ///< 0: none
    Span<const std::uint16_t> value{};     ///< as Point::initial

    constexpr bool present() const { return timeout.count() > 0; }
  };

  double rate = 0;  ///< Hz; 0: the map's
  Publish publish = Publish::always;
  double deadband = 0;  ///< with on_change: published when it differs from the last by more
  std::chrono::milliseconds max_interval{
      0};  ///< with on_change: published at least so often; 0: never for that
  bool latch = false;
  bool stamped = false;  ///< also published with the time at which the value was true; not for arrays
  std::uint32_t queue_size = 10;  ///< of the topic; its subscription to writes holds ten times as many
  WriteFunction write_function = WriteFunction::automatic;
  WriteQueue write_queue = WriteQueue::latest;
  Priority priority = Priority::normal;
  bool verify_write = false;  ///< read back after a write
  Deadman deadman{};
};

constexpr Enumeration<HostOptions::Publish, 2> enumeration(HostOptions::Publish) {
  using Publish = HostOptions::Publish;
  return {"HostOptions::Publish", {{Publish::always, "always"}, {Publish::on_change, "on_change"}}};
}
constexpr Enumeration<HostOptions::WriteFunction, 3> enumeration(HostOptions::WriteFunction) {
  using Function = HostOptions::WriteFunction;
  return {"HostOptions::WriteFunction",
          {{Function::automatic, "automatic", ""},
           {Function::single, "single"},
           {Function::multiple, "multiple"}}};
}
constexpr Enumeration<HostOptions::WriteQueue, 2> enumeration(HostOptions::WriteQueue) {
  using Queue = HostOptions::WriteQueue;
  return {"HostOptions::WriteQueue", {{Queue::latest, "latest"}, {Queue::every, "every"}}};
}
constexpr Enumeration<HostOptions::Priority, 2> enumeration(HostOptions::Priority) {
  using Priority = HostOptions::Priority;
  return {"HostOptions::Priority", {{Priority::normal, "normal"}, {Priority::high, "high"}}};
}

/// The access that clients have to a point.
enum class Access : std::uint8_t { read, write, read_write };
constexpr Enumeration<Access, 3> enumeration(Access) {
  return {"Access", {{Access::read, "read"}, {Access::write, "write"}, {Access::read_write, "read_write"}}};
}

/// Between which numbers a point's values are, in published units. It does not concern how they stand in
/// their registers, so it is not in the fingerprint.
struct Bounds {
  static constexpr double no_min = std::numeric_limits<double>::lowest();
  static constexpr double no_max = std::numeric_limits<double>::max();

  double min = no_min;
  double max = no_max;
  bool allow_nonfinite = false;  ///< REAL and LREAL: NaN and the infinities may be written
};

/// The name of a value of an integer.
struct NamedValue {
  std::int64_t value = 0;
  std::string_view name;  ///< an identifier
};

/// Raw values of a point, from `first` to `last`: its bits as an unsigned number of the type's width, or
/// those of the whole register if it is a BOOL.
struct RawRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
};

/// The raw numbers between which a value is one: beyond them something is broken, such as the wire of a
/// 4 to 20 mA signal. They do not concern how a value stands in its registers, so they are not in the
/// fingerprint.
struct Faults {
  static constexpr double no_below = std::numeric_limits<double>::lowest();
  static constexpr double no_above = std::numeric_limits<double>::max();

  double below = no_below;  ///< a smaller number is a fault
  double above = no_above;  ///< a greater number is a fault

  constexpr bool present() const { return below != no_below || above != no_above; }
  constexpr bool is_below(double raw) const { return below != no_below && raw < below; }
  constexpr bool is_above(double raw) const { return above != no_above && raw > above; }
};

/// One named value of a coupler. A literal type, so that a generated table is constant data.
struct Point {
  std::string_view name;  ///< a valid ROS name, unique in the map
  Table table = Table::coils;
  std::uint16_t address = 0;  ///< zero-based
  codec::Format format;
  Access access = Access::read;
  /// The value at start: range(point).count() registers as they stand on the wire, the bits of other points
  /// zero (for bit tables as many elements, 0 or 1). Empty: all zero.
  Span<const std::uint16_t> initial;
  /// The state of outputs with hardware (a coil with a line, a register with `iio` or `pwm`) when the node
  /// stops. The driver leaves outputs in it under on_shutdown: safe, or when it is asked to.
  Safe safe = Safe::off;
  Line line;
  std::string_view description;
  std::string_view units;
  EdgeOf counter{};         ///< a register that counts an input's edges; a holding register can be preset
  EdgeOf latched{};         ///< a coil, or a bit of a holding register: set by the edge, cleared by writing 0
  std::uint16_t count = 1;  ///< values in the point, one behind the other; more than one: an array
  codec::Scale scale{};     ///< registers: what the host publishes is a Float64
  Iio iio{};
  Pwm pwm{};
  /// With Safe::on: what a register goes to, as `initial`. Coils: empty, that is on, or an element a bit.
  Span<const std::uint16_t> safe_value{};
  /// Holding registers and coils: where the output reads back, if not at its own address.
  std::optional<std::uint16_t> read_address{};
  Bounds bounds{};
  /// The names of the values of an integer without a scale, in ascending order. Other values are not written.
  Span<const NamedValue> values{};
  /// Registers: what the device gives where it has no value. The host does not publish it. It does not
  /// concern how values stand in their registers, so it is not in the fingerprint.
  Span<const RawRange> invalid{};
  Faults faults{};  ///< SINT … ULINT, REAL, LREAL
  /// Coils of a node: how long 1 is driven; 0: until it is written otherwise. The host does not restore or
  /// verify what ends by itself.
  std::chrono::milliseconds pulse{0};
  HostOptions host{};
};

/// The addresses it occupies in its table (partial values: the register they share).
constexpr modbus::Range range(const Point& point) {
  return modbus::Range::of(point.address,
                           static_cast<std::uint32_t>(point.count) * codec::registers(point.format));
}

/// The place where the host reads it.
constexpr modbus::Range read_range(const Point& point) {
  return modbus::Range::of(point.read_address.value_or(point.address), range(point).count());
}

constexpr bool is_analogue(const Point& point) { return point.iio.present() || point.pwm.present(); }

constexpr bool is_readable(const Point& point) { return point.access != Access::write; }
constexpr bool is_writable(const Point& point) { return point.access != Access::read; }

/// The node has hardware behind it: a line, a channel, or an input whose edges it shows.
constexpr bool has_hardware(const Point& point) {
  return point.line.present() || is_analogue(point) || point.counter.present() || point.latched.present();
}

/// Values that a client writes go to the firmware's code if there is any, otherwise into memory.
constexpr bool is_hooked_output(const Point& point) { return is_writable(point) && !has_hardware(point); }

/// The firmware's code may set its value.
constexpr bool is_set_by_firmware(const Point& point) { return is_readable(point) && !has_hardware(point); }

/// Its value is on or off.
constexpr bool is_single_bit(const Point& point) {
  return point.format.type == codec::Type::BOOL && point.count == 1;
}

/// Goes back to 0 by itself.
constexpr bool is_pulsed(const Point& point) { return point.pulse.count() > 0; }

/// Shares its register with others. Bits of the bit tables share nothing.
constexpr bool is_partial(const Point& point) {
  return !holds_bits(point.table) && codec::is_partial(point.format);
}

/// The bits of its registers that are its own: all, unless it shares its register.
constexpr std::uint16_t own_bits(const Point& point) {
  return is_partial(point) ? codec::mask(point.format) : std::uint16_t{0xFFFF};
}

}  // namespace coupler
