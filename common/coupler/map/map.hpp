// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string_view>

#include "coupler/base/enumeration.hpp"
#include "coupler/base/span.hpp"
#include "coupler/map/point.hpp"
#include "coupler/map/security.hpp"
#include "coupler/map/serial.hpp"
#include "coupler/map/watchdog.hpp"
#include "coupler/modbus/limits.hpp"

namespace coupler {

/// Raised with every change to Map, Point or what they hold: a table that was generated for another one does
/// not compile.
constexpr int model_version = 20;

/// The place of the coupler. ROS parameters and arguments override it.
struct Connection {
  std::string_view address;                   ///< host name or IP address; empty: not in the map
  std::uint16_t port = modbus::default_port;  ///< where the host connects; with TLS that for TLS
  std::uint8_t unit = 1;
  std::chrono::milliseconds timeout = usual_timeout(false);
  Framing framing = Framing::tcp;  ///< at `address`; a serial port has RTU
  Serial serial{};                 ///< instead of `address`
  Tls tls{};                       ///< absent: plain Modbus/TCP

  constexpr bool is_rtu() const { return serial.present() || framing == Framing::rtu; }
  constexpr bool present() const { return serial.present() || !address.empty(); }
  /// It goes to all units of a line, and none answers (MSL 2.1).
  constexpr bool is_broadcast() const { return is_rtu() && unit == rtu_broadcast; }
  /// The way to the device is another one: a timeout that nobody has chosen goes with it.
  constexpr void changed_from(bool was_rtu) {
    if (timeout == usual_timeout(was_rtu)) timeout = usual_timeout(is_rtu());
  }
};

/// How the host reads it. A gap is the distance between the end of one point and the start of the next;
/// points are joined when it is strictly below the limit and unmapped addresses may be read.
struct Polling {
  double rate = 10;  ///< Hz
  bool discrete_continuous = false;
  std::uint16_t discrete_gap = 64;
  bool register_continuous = false;
  std::uint16_t register_gap = 12;
};

/// The limits of the device: how much it takes in one request, and how often.
struct Limits {
  std::uint16_t read_registers = 125;
  std::uint16_t read_bits = 2000;
  std::uint16_t write_registers = 123;
  std::uint16_t write_bits = 1968;
  std::chrono::milliseconds request_gap{0};    ///< pause between a reply and the next request
  std::chrono::milliseconds connect_delay{0};  ///< pause between connecting and the first request
  std::uint16_t connections = 1;
  bool mask_write = false;  ///< the device has FC 22
  /// Over Modbus/TCP, the device repeats the transaction id of a request in its reply. Otherwise all requests
  /// have 0, and a request without a reply ends the connection.
  bool transaction_ids = true;
};

/// It is read, or the others of its register are before it is written.
constexpr bool needs_answers(const Point& point, const Limits& limits) {
  return is_readable(point) || (is_partial(point) && !limits.mask_write);
}

/// Addresses of a table.
struct TableRange {
  Table table = Table::coils;
  modbus::Range range;
};

/// How a node serves the map.
struct Service {
  std::string_view listen;  ///< address to listen on; empty: every interface (loopback if simulated)
  Span<const std::string_view> allow{};  ///< addresses and CIDR ranges that may connect; empty: everyone
  Watchdog watchdog;
  bool readback = false;                      ///< compare an output's level after driving it
  std::uint16_t port = modbus::default_port;  ///< for clients without TLS
};

/// The behaviour of the host when the connection comes and goes.
enum class OnReconnect : std::uint8_t {
  drop,    ///< writes that found no link are lost
  restore  ///< the last value of every output that was written is written again
};
constexpr Enumeration<OnReconnect, 2> enumeration(OnReconnect) {
  return {"OnReconnect", {{OnReconnect::drop, "drop"}, {OnReconnect::restore, "restore"}}};
}
enum class OnShutdown : std::uint8_t {
  hold,  ///< outputs stay as they are
  safe   ///< outputs go to their safe values: Point::safe, Point::safe_value
};
constexpr Enumeration<OnShutdown, 2> enumeration(OnShutdown) {
  return {"OnShutdown", {{OnShutdown::hold, "hold"}, {OnShutdown::safe, "safe"}}};
}

/// The choice of the points that the driver reads.
enum class Poll : std::uint8_t {
  all,
  subscribed  ///< those with subscribers
};
constexpr Enumeration<Poll, 2> enumeration(Poll) {
  return {"Poll", {{Poll::all, "all"}, {Poll::subscribed, "subscribed"}}};
}

/// The behaviour of the host if the device has another map.
enum class Verify : std::uint8_t {
  require,  ///< do not talk to the device
  warn,     ///< report it and go on
  off       ///< do not ask
};
constexpr Enumeration<Verify, 3> enumeration(Verify) {
  return {"Verify", {{Verify::require, "require"}, {Verify::warn, "warn"}, {Verify::off, "off"}}};
}

/// The result of closing a tool that holds nothing, as far as `holds` says.
enum class OnEmpty : std::uint8_t {
  abort,  ///< its goal fails
  ok      ///< its goal succeeds
};
constexpr Enumeration<OnEmpty, 2> enumeration(OnEmpty) {
  return {"OnEmpty", {{OnEmpty::abort, "abort"}, {OnEmpty::ok, "ok"}}};
}

/// What a tool does when its goal is cancelled.
enum class OnCancel : std::uint8_t {
  stay,  ///< nothing more is driven
  open,
  close
};
constexpr Enumeration<OnCancel, 3> enumeration(OnCancel) {
  return {"OnCancel", {{OnCancel::stay, "stay"}, {OnCancel::open, "open"}, {OnCancel::close, "close"}}};
}

/// The ends of a tool as positions of a joint, in metres or radians.
struct JointPositions {
  double open = 1;
  double closed = 0;
};
constexpr bool operator==(const JointPositions& a, const JointPositions& b) {
  return a.open == b.open && a.closed == b.closed;
}
constexpr bool operator!=(const JointPositions& a, const JointPositions& b) { return !(a == b); }

/// Something with two ends: a gripper, a clamp, a cylinder, a vacuum cup. Its points are bits of the map; one
/// that it does not have is empty.
struct Tool {
  std::string_view name;
  std::string_view close;               ///< the output that is on to close it; empty: `open` off closes it
  std::string_view open;                ///< the output that is on to open it; empty: `close` off opens it
  std::string_view closed;              ///< the input that is on at the closed end
  std::string_view opened;              ///< the input that is on at the open end
  std::string_view holds;               ///< the input that is on while it holds a part
  std::chrono::milliseconds travel{0};  ///< to an end that has no input; 0: both ends have one
  std::chrono::milliseconds timeout{2000};  ///< after that it is stuck; at least `travel`
  std::chrono::milliseconds settle{0};      ///< an input counts when it has been on for so long
  bool hold = true;  ///< its output stays on at the end; otherwise it is switched off there
  OnEmpty empty = OnEmpty::abort;
  bool direct = false;       ///< programs may also write its outputs directly
  std::string_view joint{};  ///< its name as a joint; empty: joint_name() has the usual one
  JointPositions positions{};
  OnCancel on_cancel = OnCancel::stay;
};

/// A value of an axis's point as a position of its joint.
struct AxisPosition {
  std::int64_t value = 0;  ///< 0 or 1 of a BOOL; otherwise the integer
  double position = 0;
};

constexpr bool operator==(const AxisPosition& a, const AxisPosition& b) {
  return a.value == b.value && a.position == b.position;
}
constexpr bool operator==(Span<const AxisPosition> a, Span<const AxisPosition> b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!(a[i] == b[i])) return false;
  return true;
}
constexpr bool operator!=(Span<const AxisPosition> a, Span<const AxisPosition> b) { return !(a == b); }

/// An output as a joint of a trajectory.
struct Axis {
  std::string_view name;
  std::string_view point;    ///< a writable point with one value: a BOOL or a number
  std::string_view joint{};  ///< its name as a joint; empty: joint_name() has the usual one
  /// The positions of its values, in ascending order of the position. Empty: the position is the published
  /// value.
  Span<const AxisPosition> positions{};
};

/// One wire of the simulated chip: `from` an output `to` an input, or a square wave `to` an input.
struct SimWire {
  std::string_view from;  ///< a coil; empty: a square wave
  std::string_view to;    ///< a discrete input
  bool invert = false;
  std::chrono::microseconds square{0};  ///< the wave's period, half of it on
};

/// One coupler. A view of constant data: a generated table, or what OwnedMap holds. Copy it to override a
/// field.
struct Map {
  std::string_view name;  ///< namespace of the topics
  Connection connection;
  Polling polling;
  Limits limits;
  Span<const Point> points;  ///< sorted as canonical_less() (fingerprint.hpp) says
  Span<const SimWire> sim;
  std::uint64_t fingerprint = 0;
  std::string_view text;       ///< the file as it was read, UTF-8: what a node serves by FC 20
  std::uint32_t text_crc = 0;  ///< crc32(text)
  Service service{};
  OnReconnect on_reconnect = OnReconnect::drop;
  OnShutdown on_shutdown = OnShutdown::hold;
  Span<const TableRange>
      unreadable{};  ///< by place: the device refuses them; never read, not even between points
  WatchdogSequences coupler_watchdog{};
  Poll poll = Poll::all;
  bool changes = true;  ///< the driver listens to changes that a node announces; false: it polls only
  Verify verify = Verify::require;
  Security security{};
  Span<const TableRange> read_whole{};  ///< by place, none overlaps another: read whole for any point in it
  bool wait_for = false;                ///< the driver serves an action that waits for values
  Span<const Tool> tools{};             ///< in the order of the file
  Span<const Axis> axes{};              ///< in the order of the file
  double joint_rate = 10;               ///< Hz, at which the driver publishes the positions of tools and axes
};

/// The point of that name, or nullptr.
constexpr const Point* find(const Map& map, std::string_view name) {
  for (const Point& point : map.points)
    if (point.name == name) return &point;
  return nullptr;
}

/// Returns whether the point hides the action: it has the action's name, or a name below it, where the
/// action's own topics and services are.
constexpr bool takes_place_of(std::string_view point, std::string_view action) {
  if (point.substr(0, action.size()) != action) return false;
  return point.size() == action.size() || point[action.size()] == '/';
}

/// Returns whether a point hides the action.
constexpr bool is_taken(const Map& map, std::string_view action) {
  for (const Point& point : map.points)
    if (takes_place_of(point.name, action)) return true;
  return false;
}

/// The tool that has the point of that name as an output, or nullptr.
constexpr const Tool* tool_with_output(const Map& map, std::string_view point) {
  for (const Tool& tool : map.tools)
    if (tool.close == point || tool.open == point) return &tool;
  return nullptr;
}

/// Returns the device's port for programs that have no TLS.
constexpr std::uint16_t port_without_tls(const Map& map) {
  return map.connection.tls.present() ? map.service.port : map.connection.port;
}

}  // namespace coupler
