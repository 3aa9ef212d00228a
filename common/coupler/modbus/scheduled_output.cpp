// SPDX-License-Identifier: Apache-2.0
#include "coupler/modbus/scheduled_output.hpp"

#include <cassert>

namespace coupler::modbus {
namespace {

constexpr auto function = static_cast<std::uint8_t>(Function::schedule_output);
constexpr std::uint8_t version = 1;
constexpr std::uint8_t schedule = 1;
constexpr std::uint8_t cancel_operation = 2;
constexpr std::uint8_t cancel_from_operation = 3;
constexpr std::size_t common_size = 7;  ///< function, version, operation, epoch
constexpr std::size_t values_at = 25;
constexpr std::size_t cancel_size = 9;
constexpr std::size_t cancel_from_size = 20;
constexpr std::size_t reply_size = 20;
static_assert(values_at + max_scheduled_bits / 8 == max_pdu_size);
static_assert(values_at + std::size_t{2} * max_scheduled_registers == max_pdu_size);

constexpr auto bad_value = Exception::illegal_data_value;

using Parsed = tl::expected<std::variant<ScheduleOutput, CancelOutput, CancelOutputs>, Exception>;

constexpr bool is_of_outputs(Function table) {
  return table == Function::read_coils || table == Function::read_holding_registers;
}

Parsed parse_schedule(Bytes pdu) {
  if (pdu.size() < values_at) return tl::unexpected(bad_value);
  const std::chrono::milliseconds duration(get_u32(&pdu[15]));
  const auto table = static_cast<Function>(pdu[19]);
  const bool bits = table == Function::read_coils;
  if (duration > longest_duration || !is_of_outputs(table)) return tl::unexpected(bad_value);
  const std::uint16_t count = get_u16(&pdu[22]);
  const std::size_t bytes = bits ? (count + std::size_t{7}) / 8 : std::size_t{2} * count;
  if (count == 0 || count > (bits ? max_scheduled_bits : max_scheduled_registers) || pdu[24] != bytes ||
      pdu.size() != values_at + bytes)
    return tl::unexpected(bad_value);
  const auto range = Range::make(get_u16(&pdu[20]), count);
  if (!range) return tl::unexpected(Exception::illegal_data_address);
  return ScheduleOutput{get_u32(&pdu[3]), get_time(&pdu[7]), duration, table, *range, pdu.from(values_at)};
}

Parsed parse_cancel(Bytes pdu) {
  if (pdu.size() != cancel_size) return tl::unexpected(bad_value);
  return CancelOutput{get_u32(&pdu[3]), get_u16(&pdu[common_size])};
}

Parsed parse_cancel_from(Bytes pdu) {
  if (pdu.size() != cancel_from_size) return tl::unexpected(bad_value);
  const auto table = static_cast<Function>(pdu[15]);
  const std::uint16_t count = get_u16(&pdu[18]);
  if (!is_of_outputs(table) || count == 0) return tl::unexpected(bad_value);
  const auto range = Range::make(get_u16(&pdu[16]), count);
  if (!range) return tl::unexpected(Exception::illegal_data_address);
  return CancelOutputs{get_u32(&pdu[3]), get_time(&pdu[common_size]), table, *range};
}

}  // namespace

ScheduleRequest::ScheduleRequest(std::uint8_t operation, std::uint32_t epoch) : size_(common_size) {
  bytes_[0] = function;
  bytes_[1] = version;
  bytes_[2] = operation;
  put_u32(&bytes_[3], epoch);
}

void ScheduleRequest::put_head(const ScheduleOutput& when, Function table, std::size_t count,
                               std::size_t bytes) {
  assert(when.duration <= longest_duration && values_at + bytes <= bytes_.size());
  put_time(&bytes_[7], when.due);
  put_u32(&bytes_[15], static_cast<std::uint32_t>(when.duration.count()));
  bytes_[19] = static_cast<std::uint8_t>(table);
  put_u16(&bytes_[20], when.range.start());
  put_u16(&bytes_[22], static_cast<std::uint16_t>(count));
  bytes_[24] = static_cast<std::uint8_t>(bytes);
  size_ = values_at + bytes;
}

ScheduleRequest ScheduleRequest::coils(const ScheduleOutput& when, Span<const std::uint16_t> bits) {
  assert(!bits.empty() && bits.size() <= max_scheduled_bits);
  ScheduleRequest request(schedule, when.epoch);
  request.put_head(when, Function::read_coils, bits.size(), (bits.size() + 7) / 8);
  for (std::size_t i = 0; i < bits.size(); ++i)
    if (bits[i] != 0)
      request.bytes_[values_at + i / 8] =
          static_cast<std::uint8_t>(request.bytes_[values_at + i / 8] | 1U << i % 8);
  return request;
}

ScheduleRequest ScheduleRequest::registers(const ScheduleOutput& when, Span<const std::uint16_t> values) {
  assert(!values.empty() && values.size() <= max_scheduled_registers);
  ScheduleRequest request(schedule, when.epoch);
  request.put_head(when, Function::read_holding_registers, values.size(), 2 * values.size());
  for (std::size_t i = 0; i < values.size(); ++i) put_u16(&request.bytes_[values_at + 2 * i], values[i]);
  return request;
}

ScheduleRequest ScheduleRequest::cancel(const CancelOutput& what) {
  ScheduleRequest request(cancel_operation, what.epoch);
  put_u16(&request.bytes_[common_size], what.number);
  request.size_ = cancel_size;
  return request;
}

ScheduleRequest ScheduleRequest::cancel_from(const CancelOutputs& what) {
  assert(what.range.count() <= 0xFFFF);
  ScheduleRequest request(cancel_from_operation, what.epoch);
  put_time(&request.bytes_[common_size], what.from);
  request.bytes_[15] = static_cast<std::uint8_t>(what.table);
  put_u16(&request.bytes_[16], what.range.start());
  put_u16(&request.bytes_[18], static_cast<std::uint16_t>(what.range.count()));
  request.size_ = cancel_from_size;
  return request;
}

tl::expected<std::variant<ScheduleOutput, CancelOutput, CancelOutputs>, Exception> parse_schedule_request(
    Bytes pdu) {
  if (pdu.size() < common_size || pdu[1] != version) return tl::unexpected(bad_value);
  switch (pdu[2]) {
    case schedule: return parse_schedule(pdu);
    case cancel_operation: return parse_cancel(pdu);
    case cancel_from_operation: return parse_cancel_from(pdu);
    default: return tl::unexpected(bad_value);
  }
}

std::size_t reply_schedule(const ScheduleReply& reply, Span<std::uint8_t> pdu) {
  pdu[0] = function;
  pdu[1] = version;
  put_u16(&pdu[2], reply.number);
  put_time(&pdu[4], reply.arrived);
  put_time(&pdu[12], reply.replied);
  return reply_size;
}

tl::expected<ScheduleReply, ReplyError> parse_schedule_reply(Bytes pdu) {
  if (pdu.size() != reply_size || pdu[0] != function || pdu[1] != version)
    return tl::unexpected(reply_error(function, pdu));
  return ScheduleReply{get_u16(&pdu[2]), get_time(&pdu[4]), get_time(&pdu[12])};
}

}  // namespace coupler::modbus
