// SPDX-License-Identifier: Apache-2.0
// What tests of outputs at a time share.
#pragma once

#include <gtest/gtest.h>

#include "coupler/device/core/timed_output_end.hpp"
#include "coupler/map/functions.hpp"
#include "test/device/core/node_under_test.hpp"

namespace coupler::device {

inline auto with_line(Safe safe) {
  return [safe](Point& point) {
    point.safe = safe;
    point.line.name = "line";
  };
}

/// Coils 0 … 3 have lines: safe off, on, off, hold; coil 4 is memory, coil 5 a latch of input 0. Registers 0
/// and 1 are memory, 2 is an analogue output of two registers, 4 holds a byte up to 10, 5 cannot be written.
class ScheduledOutputs : public testing::Test {
 protected:
  static constexpr std::chrono::milliseconds timeout{500};  ///< of the watchdog
  static constexpr std::uint32_t epoch = 0xA1B2C3D4;

  explicit ScheduledOutputs(Watchdog::Recovery recovery = Watchdog::Recovery::automatic)
      : node_(fakes::MapBuilder()
                  .add(Table::coils, "relay", 0, codec::Type::BOOL, with_line(Safe::off))
                  .add(Table::coils, "brake", 1, codec::Type::BOOL, with_line(Safe::on))
                  .add(Table::coils, "lamp", 2, codec::Type::BOOL, with_line(Safe::off))
                  .add(Table::coils, "held", 3, codec::Type::BOOL, with_line(Safe::hold))
                  .many(Table::coils, 4, 1)
                  .input("edge", 0)
                  .add(Table::coils, "seen", 5, codec::Type::BOOL,
                       [](Point& point) {
                         point.latched = {"edge", Edge::rising};
                       })
                  .many(Table::holding_registers, 0, 2)
                  .add(Table::holding_registers, "valve", 2, codec::Type::REAL,
                       [](Point& point) {
                         point.format.order = codec::Order::ABCD;
                         point.pwm.chip = "pwm";
                       })
                  .add(Table::holding_registers, "level", 4, codec::Type::UINT,
                       [](Point& point) { point.bounds.max = 10; })
                  .add(Table::holding_registers, "shown", 5, codec::Type::UINT,
                       [](Point& point) { point.access = Access::read; })
                  .watchdog({timeout, Watchdog::FedBy::any, recovery})
                  .build()) {
    node_.lines.outputs = {{0, {0, 0}}, {1, {1, 0}}, {2, {0, 0}}};
    node_.now = TimePoint(std::chrono::hours(5));
    node_.handler.tell_changes(epoch, node_.now);
  }

  TimePoint in(std::chrono::milliseconds time) const { return node_.now + time; }
  modbus::ScheduleOutput when(TimePoint due, modbus::Range range, std::chrono::milliseconds duration) const {
    return {epoch, node_time(due), duration, modbus::Function::read_coils, range, {}};
  }
  Pdu coils(TimePoint due, std::uint32_t first, const std::vector<std::uint16_t>& bits,
            std::chrono::milliseconds duration = std::chrono::milliseconds(0)) const {
    const auto range = modbus::Range::of(first, static_cast<std::uint32_t>(bits.size()));
    const modbus::ScheduleRequest request = modbus::ScheduleRequest::coils(when(due, range, duration), bits);
    const auto bytes = request.pdu();
    return Pdu(bytes.begin(), bytes.end());
  }
  Pdu registers(TimePoint due, std::uint32_t first, const std::vector<std::uint16_t>& values,
                std::chrono::milliseconds duration = std::chrono::milliseconds(0)) const {
    const auto range = modbus::Range::of(first, static_cast<std::uint32_t>(values.size()));
    const modbus::ScheduleRequest request =
        modbus::ScheduleRequest::registers(when(due, range, duration), values);
    const auto bytes = request.pdu();
    return Pdu(bytes.begin(), bytes.end());
  }
  Pdu cancel(std::uint16_t number) const {
    const auto bytes = modbus::ScheduleRequest::cancel({epoch, number});
    return Pdu(bytes.pdu().begin(), bytes.pdu().end());
  }
  Pdu cancel_from(TimePoint from, Table table, modbus::Range range) const {
    const auto bytes =
        modbus::ScheduleRequest::cancel_from({epoch, node_time(from), read_function(table), range});
    return Pdu(bytes.pdu().begin(), bytes.pdu().end());
  }
  /// The number that it is given; 0: it is refused.
  std::uint16_t accept(const Pdu& request) { return accept(node_.session, request); }
  std::uint16_t accept(ClientSession& who, const Pdu& request) {
    const auto reply = modbus::parse_schedule_reply(node_.ask(who, request));
    return reply ? reply->number : std::uint16_t{0};
  }
  void pass(std::chrono::milliseconds time) {
    node_.now += time;
    node_.handler.tick(node_.now);
  }
  std::vector<int> levels() const {
    std::vector<int> all;
    for (const std::uint16_t cell : node_.image.find(Table::coils, modbus::Range::of(0, 6)))
      all.push_back(cell);
    return all;
  }
  std::vector<int> values(std::uint32_t first, std::uint32_t count) const {
    std::vector<int> all;
    for (const std::uint16_t cell :
         node_.image.find(Table::holding_registers, modbus::Range::of(first, count)))
      all.push_back(cell);
    return all;
  }
  modbus::Change outcome(modbus::Change::Kind kind, modbus::Reason reason, std::uint16_t number) const {
    return {static_cast<std::uint8_t>(reason), kind, number, node_time(node_.now)};
  }
  modbus::Change cancelled(modbus::Reason reason, std::uint16_t number) const {
    return outcome(modbus::Change::Kind::cancelled, reason, number);
  }

  NodeUnderTest node_;
  ClientSession other_;
};

}  // namespace coupler::device
