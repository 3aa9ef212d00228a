// SPDX-License-Identifier: Apache-2.0
#include "coupler/modbus/rtu_frame.hpp"

#include <algorithm>
#include <cassert>

#include "coupler/modbus/device_identification.hpp"

namespace coupler::modbus {
namespace {

constexpr std::size_t crc_size = 2;

constexpr std::array<std::uint16_t, 256> make_crc_table() {
  std::array<std::uint16_t, 256> table{};
  for (unsigned byte = 0; byte < table.size(); ++byte) {
    unsigned crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xA001U : 0U);
    table[byte] = static_cast<std::uint16_t>(crc);
  }
  return table;
}
constexpr std::array<std::uint16_t, 256> crc_table = make_crc_table();

bool starts_with(Bytes bytes, Bytes beginning) {
  return bytes.size() >= beginning.size() && std::equal(beginning.begin(), beginning.end(), bytes.begin());
}

}  // namespace

std::uint16_t crc16(Bytes bytes) {
  unsigned crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) crc = crc >> 8 ^ crc_table[(crc ^ byte) & 0xFF];
  return static_cast<std::uint16_t>(crc);
}

std::size_t put_rtu_frame(std::uint8_t unit, Bytes pdu, std::uint8_t* frame) {
  assert(!pdu.empty() && pdu.size() <= max_pdu_size);
  frame[0] = unit;
  std::copy(pdu.begin(), pdu.end(), frame + 1);
  const std::size_t size = 1 + pdu.size();
  const std::uint16_t crc = crc16({frame, size});
  frame[size] = static_cast<std::uint8_t>(crc);
  frame[size + 1] = static_cast<std::uint8_t>(crc >> 8);
  return size + crc_size;
}

std::optional<std::size_t> reply_size(Bytes request, Bytes beginning) {
  if (beginning.size() < 2) return 0;
  if ((beginning[0] & exception_bit) != 0) return 2;
  switch (static_cast<Function>(beginning[0])) {
    case Function::read_coils:
    case Function::read_discrete_inputs:
    case Function::read_holding_registers:
    case Function::read_input_registers:
    case Function::read_file_record:
    case Function::read_write_multiple_registers: return std::size_t{2} + beginning[1];
    case Function::write_single_coil:
    case Function::write_single_register:
    case Function::write_multiple_coils:
    case Function::write_multiple_registers: return 5;
    case Function::mask_write_register: return 7;
    case Function::diagnostics: return request.size();
    case Function::encapsulated_interface:
      if (beginning[1] == mei_device_identification) return identification_reply_size(beginning);
      return std::nullopt;
    default: return std::nullopt;
  }
}

std::optional<std::size_t> answer_size(Bytes request) {
  if (request.size() < 5) return std::nullopt;
  const std::size_t count = get_u16(&request[3]);
  switch (static_cast<Function>(request[0])) {
    case Function::read_coils:
    case Function::read_discrete_inputs: return 2 + (count + 7) / 8;
    case Function::read_holding_registers:
    case Function::read_input_registers: return 2 + 2 * count;
    case Function::write_single_coil:
    case Function::write_single_register:
    case Function::write_multiple_coils:
    case Function::write_multiple_registers: return 5;
    case Function::mask_write_register: return 7;
    default: return std::nullopt;
  }
}

void RtuFramer::expect(std::uint8_t unit, Bytes pdu) {
  request_size_ = put_rtu_frame(unit, pdu, request_.data());
  begin_ = end_ = come_ = 0;
  had_echo_ = false;
  pdu_ = {};
}

Span<std::uint8_t> RtuFramer::room() {
  // So much that is no reply: one that has begun is not longer than a frame.
  if (end_ == buffer_.size()) {
    std::copy(buffer_.end() - max_rtu_size, buffer_.end(), buffer_.begin());
    begin_ = 0;
    end_ = max_rtu_size;
  }
  return Span<std::uint8_t>(buffer_).from(end_);
}

void RtuFramer::filled(std::size_t bytes) {
  assert(bytes <= buffer_.size() - end_);
  end_ += bytes;
  come_ += bytes;
}

std::size_t RtuFramer::skipped() const {
  const std::size_t echo = had_echo_ ? request_size_ : 0;
  return come_ - echo - (pdu_.empty() ? 0 : pdu_.size() + rtu_overhead);
}

bool RtuFramer::holds_another_frame() const {
  const Bytes rest = Bytes(buffer_).sub(begin_, end_ - begin_);
  return rest.size() > rtu_overhead && crc16(rest) == 0;
}

/// Returns whether a PDU that is no exception has the length that was asked for. A confirmation repeats the
/// address, but a register may be stored otherwise than it was written (MAP 6.6).
bool RtuFramer::can_answer(Bytes pdu) const {
  const auto size = answer_size(request_pdu());
  if (!size) return true;
  if (pdu.size() != *size) return false;
  switch (static_cast<Function>(pdu[0])) {
    case Function::write_single_coil:
    case Function::write_single_register: return starts_with(request_pdu(), pdu.first(3));
    case Function::write_multiple_coils:
    case Function::write_multiple_registers:
    case Function::mask_write_register: return starts_with(request_pdu(), pdu);
    default: return true;
  }
}

void RtuFramer::silent() {
  if (end_ == 0) has_echo_ = false;
}

void RtuFramer::skip_echo() {
  if (had_echo_ || (is_its_own_reply(request_pdu()) && has_echo_ != true)) return;
  if (!starts_with(Bytes(buffer_).first(end_), request())) return;
  begin_ = request_size_;
  had_echo_ = true;
  has_echo_ = true;
}

bool RtuFramer::echo_may_come() const {
  return !had_echo_ && starts_with(request(), Bytes(buffer_).first(end_));
}

RtuFramer::Found RtuFramer::look_at(std::size_t begin) {
  const Bytes bytes = Bytes(buffer_).sub(begin, end_ - begin);
  if (bytes[0] != request_[0]) return Found::none;
  if (bytes.size() == 1) return Found::beginning;
  if ((bytes[1] & ~exception_bit) != request_[1]) return Found::none;
  const auto size = reply_size(request_pdu(), bytes.from(1));
  // If the length is not known, the CRC says that this may be the end.
  const std::size_t whole = size ? 1 + *size + crc_size : std::max(bytes.size(), 2 + crc_size);
  if (whole > max_rtu_size) return Found::none;
  if (size == std::size_t{0} || bytes.size() < whole) return Found::beginning;
  if (crc16(bytes.first(whole)) != 0) return size ? Found::none : Found::beginning;
  const Bytes pdu = bytes.sub(1, whole - 1 - crc_size);
  if ((pdu[0] & exception_bit) == 0 && !can_answer(pdu)) return Found::none;
  pdu_ = pdu;
  return Found::reply;
}

RtuFramer::Outcome RtuFramer::next() {
  skip_echo();
  bool has_begun = begin_ == end_ || echo_may_come();
  // Only then: a reply to a write of several begins like its request, and its CRC may be what is written.
  if (has_begun && has_echo_ == true) return Outcome::nothing;
  for (std::size_t begin = begin_; begin < end_; ++begin) {
    const Found found = look_at(begin);
    if (found == Found::reply) {
      if (!had_echo_ && !is_its_own_reply(request_pdu())) has_echo_ = false;
      return Outcome::reply;
    }
    has_begun |= found == Found::beginning;
  }
  return has_begun ? Outcome::nothing : Outcome::damaged;
}

}  // namespace coupler::modbus
