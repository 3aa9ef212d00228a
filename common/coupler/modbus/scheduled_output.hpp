// SPDX-License-Identifier: Apache-2.0
// Outputs at a time (function code 66), both directions. docs/time.md has the bytes.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <tl/expected.hpp>
#include <variant>

#include "coupler/base/span.hpp"
#include "coupler/modbus/limits.hpp"
#include "coupler/modbus/node_time.hpp"
#include "coupler/modbus/pdu.hpp"
#include "coupler/modbus/range.hpp"

namespace coupler::modbus {

constexpr std::uint16_t max_scheduled_bits = 1824;
constexpr std::uint16_t max_scheduled_registers = 114;
constexpr std::chrono::milliseconds longest_duration = std::chrono::hours(1);

/// Drives outputs when the node's clock says `due`. Bytes are a view of the request's PDU.
struct ScheduleOutput {
  std::uint32_t epoch = 0;  ///< in which it holds: ChangesReply's
  NodeTime due{};
  std::chrono::milliseconds duration{};   ///< after it they are as they were before; 0: for good
  Function table = Function::read_coils;  ///< FC 1 or 3: what reads them
  Range range = Range::of(0, 1);
  Bytes values{};  ///< as in FC 15 or 16
};

/// Cancels what has not begun.
struct CancelOutput {
  std::uint32_t epoch = 0;
  std::uint16_t number = 0;  ///< ScheduleReply's
};

/// Cancels all that this connection has scheduled, that overlaps the range and is due then or later, and that
/// has not begun.
struct CancelOutputs {
  std::uint32_t epoch = 0;
  NodeTime from{};
  Function table = Function::read_coils;  ///< as ScheduleOutput's
  Range range = Range::of(0, 1);          ///< at most 65535 addresses
};

/// Answers every request.
struct ScheduleReply {
  /// Chosen by the node; Change::address says it when all is over. After CancelOutputs: how many it
  /// cancelled.
  std::uint16_t number = 0;
  NodeTime arrived{};  ///< the request
  NodeTime replied{};  ///< this reply
};

// The client's side.

/// The PDU of a request.
class ScheduleRequest {
 public:
  /// 1 … max_scheduled_bits coils; an element that is not 0 is on. `duration` is at most longest_duration.
  static ScheduleRequest coils(const ScheduleOutput& when, Span<const std::uint16_t> bits);
  /// 1 … max_scheduled_registers holding registers.
  static ScheduleRequest registers(const ScheduleOutput& when, Span<const std::uint16_t> values);
  static ScheduleRequest cancel(const CancelOutput& what);
  static ScheduleRequest cancel_from(const CancelOutputs& what);

  Bytes pdu() const { return {bytes_.data(), size_}; }

 private:
  ScheduleRequest(std::uint8_t operation, std::uint32_t epoch);
  void put_head(const ScheduleOutput& when, Function table, std::size_t count, std::size_t bytes);

  std::array<std::uint8_t, max_pdu_size> bytes_{};
  std::size_t size_ = 0;
};

tl::expected<ScheduleReply, ReplyError> parse_schedule_reply(Bytes pdu);

// The server's side.

/// `pdu` has at least one byte. Errors: 03 a length, version, operation, duration, table or quantity that is
/// not allowed, or a byte count that does not match; 02 a range that runs past address 65535.
tl::expected<std::variant<ScheduleOutput, CancelOutput, CancelOutputs>, Exception> parse_schedule_request(
    Bytes pdu);

/// `pdu` holds at least max_pdu_size bytes. Returns the size.
std::size_t reply_schedule(const ScheduleReply& reply, Span<std::uint8_t> pdu);

}  // namespace coupler::modbus
