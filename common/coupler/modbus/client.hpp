// SPDX-License-Identifier: Apache-2.0
// The client's side: PDUs that read (FC 1 to 4) and write (FC 5, 6, 15, 16, 22), and what their replies say.
#pragma once

#include <array>
#include <cstdint>

#include <tl/expected.hpp>

#include "coupler/base/span.hpp"
#include "coupler/modbus/limits.hpp"
#include "coupler/modbus/pdu.hpp"
#include "coupler/modbus/range.hpp"

namespace coupler::modbus {

/// The PDU of a request that reads.
class ReadRequest {
 public:
  /// At most max_read_bits or max_read_registers.
  ReadRequest(Function function, Range range);

  Bytes pdu() const { return {bytes_.data(), bytes_.size()}; }
  std::uint8_t function() const { return bytes_[0]; }
  bool reads_bits() const { return bytes_[0] <= static_cast<std::uint8_t>(Function::read_discrete_inputs); }
  std::uint16_t count() const { return get_u16(&bytes_[3]); }

 private:
  std::array<std::uint8_t, 5> bytes_{};
};

/// Takes the values out of a reply to FC 1 … 4: `values[i]` is a register, or a bit as 0 or 1.
tl::expected<void, ReplyError> take_values(const ReadRequest& request, Bytes reply, std::uint16_t* values);

/// The PDU of a request that writes.
class WriteRequest {
 public:
  static WriteRequest coil(std::uint16_t address, bool on);                        // FC 5
  static WriteRequest register_value(std::uint16_t address, std::uint16_t value);  // FC 6
  /// FC 15: 1 … max_write_bits coils; an element that is not 0 is on.
  static WriteRequest coils(std::uint16_t address, Span<const std::uint16_t> bits);
  /// FC 16: 1 … max_write_registers registers.
  static WriteRequest registers(std::uint16_t address, Span<const std::uint16_t> values);
  /// FC 22: register = (register & and_mask) | (or_mask & ~and_mask), MAP 6.16.
  static WriteRequest mask(std::uint16_t address, std::uint16_t and_mask, std::uint16_t or_mask);

  Bytes pdu() const { return {bytes_.data(), size_}; }
  Function function() const { return static_cast<Function>(bytes_[0]); }
  std::uint16_t address() const { return get_u16(&bytes_[1]); }

 private:
  WriteRequest(Function function, std::uint16_t address, std::uint16_t value);

  std::array<std::uint8_t, max_pdu_size> bytes_{};
  std::size_t size_ = 5;
};

/// Checks that the PDU `reply` answers the PDU `request`: the function code; the length of a read (FC 1 to
/// 4); what a write repeats, but not the masks of FC 22. A reply to FC 5 or 6 that repeats another value is
/// an error, too: some devices answer with the value that they stored instead.
tl::expected<void, ReplyError> check_reply(Bytes request, Bytes reply);

}  // namespace coupler::modbus
