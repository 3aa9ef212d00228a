// SPDX-License-Identifier: Apache-2.0
// Reply PDUs, built in a buffer of at least max_pdu_size bytes. Each function returns the PDU's size.
#pragma once

#include <cstddef>
#include <cstdint>

#include "coupler/base/span.hpp"
#include "coupler/modbus/bytes.hpp"
#include "coupler/modbus/exception.hpp"
#include "coupler/modbus/function.hpp"

namespace coupler::modbus {

/// `function` is the request's code as it came; 128 and above stay as they are.
std::size_t reply_exception(std::uint8_t function, Exception code, Span<std::uint8_t> pdu);

/// FC 1 and 2. A bit is on if its element is not 0; the bits that fill the last byte are 0 (MAP 6.1).
std::size_t reply_bits(Function function, Span<const std::uint16_t> bits, Span<std::uint8_t> pdu);

/// FC 3, 4 and 23.
std::size_t reply_registers(Function function, Span<const std::uint16_t> registers, Span<std::uint8_t> pdu);

/// What acknowledges a write: FC 5, 6 and 22 repeat the whole request, FC 15 and 16 its address and quantity.
std::size_t reply_written(Bytes request, Span<std::uint8_t> pdu);

}  // namespace coupler::modbus
