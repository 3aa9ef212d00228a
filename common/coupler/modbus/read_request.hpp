// SPDX-License-Identifier: Apache-2.0
// Requests that read (FC 1, 2, 3, 4; MAP 6.1 … 6.4), the client's side.
#pragma once

#include <array>
#include <cstdint>
#include <tl/expected.hpp>

#include "coupler/modbus/bytes.hpp"
#include "coupler/modbus/exception.hpp"
#include "coupler/modbus/function.hpp"
#include "coupler/modbus/range.hpp"

namespace coupler::modbus {

/// The PDU of a request that reads.
class ReadRequest {
 public:
  /// At most max_read_bits or max_read_registers.
  ReadRequest(Function function, Range range);

  Bytes pdu() const { return {bytes_.data(), bytes_.size()}; }
  std::uint8_t function() const { return bytes_[0]; }
  std::uint16_t count() const { return get_u16(&bytes_[3]); }

 private:
  std::array<std::uint8_t, 5> bytes_{};
};

/// What was read with FC 1 or 2: one element a bit, 0 or 1. `bits` has room for all that was asked for.
tl::expected<void, Refused> take_bits(const ReadRequest& request, Bytes reply, std::uint8_t* bits);

/// What was read with FC 3 or 4.
tl::expected<void, Refused> take_registers(const ReadRequest& request, Bytes reply, std::uint16_t* registers);

}  // namespace coupler::modbus
