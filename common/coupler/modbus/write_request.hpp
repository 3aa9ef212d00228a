// SPDX-License-Identifier: Apache-2.0
// Requests that write (FC 5, 6, 15, 16, 22), the client's side.
#pragma once

#include <array>
#include <cstdint>
#include <tl/expected.hpp>

#include "coupler/base/span.hpp"
#include "coupler/modbus/bytes.hpp"
#include "coupler/modbus/exception.hpp"
#include "coupler/modbus/function.hpp"
#include "coupler/modbus/limits.hpp"

namespace coupler::modbus {

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

/// The value that a reply to FC 5, 6 or 22 repeats is not compared: some devices answer with what they made
/// of it.
tl::expected<void, Refused> check_reply(const WriteRequest& request, Bytes reply);

}  // namespace coupler::modbus
