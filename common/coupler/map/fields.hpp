// SPDX-License-Identifier: Apache-2.0
// The keys of a map whose values are carried as they are: each is listed once, here, with the member that
// holds it. The reader, the generated code, `coupler diff` and the CSV go through these lists. What a key may
// be set to, its example and its explanation stand in loader/key_table.cpp.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>

#include <fmt/format.h>

#include "coupler/base/enumeration.hpp"
#include "coupler/map/map.hpp"

namespace coupler {

/// A value as a map writes it.
inline std::string written(std::string_view text) { return std::string(text); }
inline std::string written(bool value) { return value ? "true" : "false"; }
inline std::string written(std::chrono::milliseconds duration) {
  return fmt::format("{}ms", duration.count());
}
inline std::string written(std::chrono::microseconds duration) {
  return fmt::format("{}us", duration.count());
}
template <class T>
std::enable_if_t<std::is_arithmetic_v<T> || std::is_enum_v<T>, std::string> written(T value) {
  if constexpr (std::is_enum_v<T>)
    return std::string(to_string(value));
  else
    return fmt::to_string(value);
}
/// "19200 8E1"
inline std::string rate_and_parity(const Serial& line) {
  return fmt::format("{} 8{}{}", line.baud, parity_letter(line.parity), line.stop_bits);
}
/// "/dev/ttyUSB0 19200 8E1"
inline std::string written(const Serial& line) {
  if (!line.present()) return "none";
  return fmt::format("{} {}{}", line.device, rate_and_parity(line), line.rs485 ? " rs485" : "");
}

inline std::string written(const Tls& tls) {
  if (!tls.present()) return "none";
  return fmt::format("{}, {}, {}{}{}", tls.certificate, tls.key, tls.pin.empty() ? tls.ca : tls.pin,
                     tls.name.empty() ? "" : " as ", tls.name);
}

/// "{open: 0.04, closed: 0}"
inline std::string written(const JointPositions& positions) {
  return fmt::format("{{open: {}, closed: {}}}", positions.open, positions.closed);
}

/// "{0: 0, 1: 0.5}"
inline std::string written(Span<const AxisPosition> positions) {
  std::string text;
  for (const auto& [value, position] : positions)
    text += fmt::format("{}{}: {}", text.empty() ? "{" : ", ", value, position);
  return text.empty() ? text : text + '}';
}

/// The subject of a key of a point.
enum class About { point, reading, writing };

template <class Struct, class Value>
struct Field {
  std::string_view key;
  Value Struct::*member;
  std::string_view change{};  ///< what `coupler diff` calls a change of it; several keys may share a name
  About about = About::point;
  std::string_view unit{};  ///< of a number
};

template <class Struct, class Value>
constexpr Field<Struct, Value> field(std::string_view key, Value Struct::*member,
                                     std::string_view change = {}, About about = About::point,
                                     std::string_view unit = {}) {
  return {key, member, change, about, unit};
}

// Members in the order of their declaration.

constexpr auto fields_of(const Connection*) {
  constexpr std::string_view change = "connection-changed";
  return std::make_tuple(
      field("address", &Connection::address, change), field("port", &Connection::port, change),
      field("unit", &Connection::unit, change), field("timeout", &Connection::timeout, change),
      field("framing", &Connection::framing, change), field("serial", &Connection::serial, change),
      field("tls", &Connection::tls, change));
}

constexpr auto fields_of(const Tls*) {
  return std::make_tuple(field("certificate", &Tls::certificate), field("key", &Tls::key),
                         field("ca", &Tls::ca), field("name", &Tls::name), field("pin", &Tls::pin));
}

constexpr auto fields_of(const Serial*) {
  return std::make_tuple(field("device", &Serial::device), field("baud", &Serial::baud),
                         field("parity", &Serial::parity), field("stop_bits", &Serial::stop_bits),
                         field("rs485", &Serial::rs485));
}

constexpr auto fields_of(const Polling*) {
  constexpr std::string_view change = "polling-changed";
  return std::make_tuple(field("rate", &Polling::rate, "map-rate-changed", About::reading, "Hz"),
                         field("discrete_read_continuous", &Polling::discrete_continuous, change),
                         field("discrete_read_separation_gap", &Polling::discrete_gap, change),
                         field("registers_read_continuous", &Polling::register_continuous, change),
                         field("registers_read_separation_gap", &Polling::register_gap, change));
}

constexpr auto fields_of(const Limits*) {
  constexpr std::string_view change = "limits-changed";
  return std::make_tuple(
      field("read_registers", &Limits::read_registers, change),
      field("read_bits", &Limits::read_bits, change),
      field("write_registers", &Limits::write_registers, change),
      field("write_bits", &Limits::write_bits, change), field("request_gap", &Limits::request_gap, change),
      field("connect_delay", &Limits::connect_delay, change),
      field("connections", &Limits::connections, change), field("mask_write", &Limits::mask_write, change),
      field("transaction_ids", &Limits::transaction_ids, change));
}

/// And `name`, `points`, what has a list of its own, and what a preset or a list fills.
constexpr auto fields_of(const Map*) {
  return std::make_tuple(
      field("on_reconnect", &Map::on_reconnect, "on-reconnect-changed"),
      field("on_shutdown", &Map::on_shutdown, "on-shutdown-changed"),
      field("poll", &Map::poll, "poll-changed"), field("changes", &Map::changes, "changes-changed"),
      field("verify", &Map::verify, "verify-changed"), field("wait_for", &Map::wait_for, "wait-for-changed"),
      field("joint_rate", &Map::joint_rate, "joint-rate-changed", About::reading, "Hz"));
}

/// And `allow`.
constexpr auto fields_of(const Service*) {
  return std::make_tuple(field("listen", &Service::listen, "listen-changed"),
                         field("readback", &Service::readback, "readback-changed"));
}

constexpr auto fields_of(const Watchdog*) {
  constexpr std::string_view change = "watchdog-changed";
  return std::make_tuple(field("timeout", &Watchdog::timeout, change),
                         field("fed_by", &Watchdog::fed_by, change),
                         field("recovery", &Watchdog::recovery, change));
}

/// And `deadman`.
constexpr auto fields_of(const HostOptions*) {
  using H = HostOptions;
  constexpr About reading = About::reading;
  constexpr About writing = About::writing;
  return std::make_tuple(field("rate", &H::rate, "rate-changed", reading, "Hz"),
                         field("publish", &H::publish, "publish-changed", reading),
                         field("deadband", &H::deadband, "publish-changed", reading),
                         field("max_interval", &H::max_interval, "publish-changed", reading),
                         field("latch", &H::latch, "latch-changed", reading),
                         field("stamped", &H::stamped, "stamped-changed", reading),
                         field("queue_size", &H::queue_size, "queue-size-changed"),
                         field("write_function", &H::write_function, "write-changed", writing),
                         field("write_queue", &H::write_queue, "write-changed", writing),
                         field("priority", &H::priority, "write-changed", writing),
                         field("verify_write", &H::verify_write, "write-changed", writing));
}

constexpr auto fields_of(const Bounds*) {
  constexpr std::string_view change = "bounds-changed";
  return std::make_tuple(field("min", &Bounds::min, change), field("max", &Bounds::max, change),
                         field("allow_nonfinite", &Bounds::allow_nonfinite, change, About::writing));
}

constexpr auto fields_of(const Faults*) {
  constexpr std::string_view change = "faults-changed";
  return std::make_tuple(field("fault_below", &Faults::below, change, About::reading),
                         field("fault_above", &Faults::above, change, About::reading));
}

constexpr auto fields_of(const Line*) {
  return std::make_tuple(field("chip", &Line::chip), field("offset", &Line::offset),
                         field("name", &Line::name), field("active_low", &Line::active_low),
                         field("bias", &Line::bias), field("drive", &Line::drive),
                         field("debounce", &Line::debounce));
}

constexpr auto fields_of(const codec::Scale*) {
  return std::make_tuple(field("gain", &codec::Scale::gain), field("offset", &codec::Scale::offset),
                         field("exponent_of", &codec::Scale::exponent_of));
}

constexpr auto fields_of(const EdgeOf*) {
  return std::make_tuple(field("of", &EdgeOf::input), field("edge", &EdgeOf::edge));
}

constexpr auto fields_of(const Iio*) {
  return std::make_tuple(field("device", &Iio::device), field("channel", &Iio::channel));
}

constexpr auto fields_of(const Pwm*) {
  return std::make_tuple(field("chip", &Pwm::chip), field("channel", &Pwm::channel),
                         field("period", &Pwm::period));
}

constexpr auto fields_of(const SimWire*) {
  return std::make_tuple(field("from", &SimWire::from), field("to", &SimWire::to),
                         field("invert", &SimWire::invert), field("square", &SimWire::square));
}

/// And `name`.
constexpr auto fields_of(const Tool*) {
  constexpr std::string_view change = "tool-changed";
  return std::make_tuple(field("close", &Tool::close, change), field("open", &Tool::open, change),
                         field("closed", &Tool::closed, change), field("opened", &Tool::opened, change),
                         field("holds", &Tool::holds, change), field("travel", &Tool::travel, change),
                         field("timeout", &Tool::timeout, change), field("settle", &Tool::settle, change),
                         field("hold", &Tool::hold, change), field("empty", &Tool::empty, change),
                         field("direct", &Tool::direct, change), field("joint", &Tool::joint, change),
                         field("positions", &Tool::positions, change),
                         field("on_cancel", &Tool::on_cancel, change));
}

/// And `name`.
constexpr auto fields_of(const Axis*) {
  constexpr std::string_view change = "axis-changed";
  return std::make_tuple(field("point", &Axis::point, change), field("joint", &Axis::joint, change),
                         field("positions", &Axis::positions, change));
}

constexpr auto fields_of(const JointPositions*) {
  return std::make_tuple(field("open", &JointPositions::open), field("closed", &JointPositions::closed));
}

template <class T, class = void>
constexpr bool has_fields = false;
template <class T>
constexpr bool has_fields<T, std::void_t<decltype(fields_of(static_cast<const T*>(nullptr)))>> = true;

/// visit(field, value) for each.
template <class Struct, class Visit>
constexpr void for_each_field(Struct& object, const Visit& visit) {
  std::apply([&](const auto&... field) { (visit(field, object.*field.member), ...); },
             fields_of(static_cast<const std::remove_const_t<Struct>*>(nullptr)));
}

/// visit(field, value of a, value of b) for each.
template <class Struct, class Visit>
constexpr void for_each_field(Struct& a, const std::remove_const_t<Struct>& b, const Visit& visit) {
  for_each_field(a, [&](const auto& field, auto& value) { visit(field, value, b.*field.member); });
}

template <class Struct>
constexpr bool has_defaults(const Struct& object) {
  bool same = true;
  for_each_field(object, Struct{},
                 [&](const auto&, const auto& value, const auto& usual) { same = same && value == usual; });
  return same;
}

}  // namespace coupler
