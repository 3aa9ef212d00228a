// SPDX-License-Identifier: Apache-2.0
// The server's side: request PDUs are parsed, reply PDUs are built.
#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>

#include <tl/expected.hpp>

#include "coupler/base/span.hpp"
#include "coupler/modbus/changes.hpp"
#include "coupler/modbus/device_identification.hpp"
#include "coupler/modbus/file_record.hpp"
#include "coupler/modbus/pdu.hpp"
#include "coupler/modbus/range.hpp"
#include "coupler/modbus/scheduled_output.hpp"

namespace coupler::modbus {

// The requests of a client. Bytes are views of the request's PDU.

/// FC 1 … 4.
struct Read {
  Function function;
  Range range;
};

/// FC 5 and 15. Bit i of the range is bit i % 8 of byte i / 8 (MAP 6.11).
struct WriteBits {
  Range range;
  Bytes packed;
};

/// FC 6 and 16. Two bytes a register, most significant first.
struct WriteRegisters {
  Range range;
  Bytes values;
};

/// FC 22: the register becomes (register & and_mask) | (or_mask & ~and_mask).
struct MaskWrite {
  Range range;
  std::uint16_t and_mask;
  std::uint16_t or_mask;
};

/// FC 23: the write is done first.
struct ReadWriteRegisters {
  Range read;
  WriteRegisters write;
};

/// FC 8/00: the request comes back as it is (MAP 6.8.1).
struct Echo {};

using Request =
    std::variant<Echo, FileGroups, Read, ReadDeviceIdentification, WriteBits, WriteRegisters, MaskWrite,
                 ReadWriteRegisters, ChangesRequest, ScheduleOutput, CancelOutput, CancelOutputs>;

/// Reads a request PDU of at least one byte and checks all that can be checked without knowing the device, in
/// the order of MAP's state diagrams. Errors: 01 a function or sub-function that is not supported, or a code
/// of 128 and above; 03 a PDU longer or shorter than it must be, a quantity outside its limits, a byte count
/// that does not match it, a coil value other than 0x0000 and 0xFF00, a version or wait that is not allowed;
/// 02 a range that runs past address 65535.
tl::expected<Request, Exception> parse_request(Bytes pdu);

/// `function` is the request's code as it came; 128 and above stay as they are.
std::size_t reply_exception(std::uint8_t function, Exception code, Span<std::uint8_t> pdu);

/// FC 1 and 2. A bit is on if its element is not 0; the bits that fill the last byte are 0 (MAP 6.1).
std::size_t reply_bits(Function function, Span<const std::uint16_t> bits, Span<std::uint8_t> pdu);

/// FC 3, 4 and 23.
std::size_t reply_registers(Function function, Span<const std::uint16_t> registers, Span<std::uint8_t> pdu);

/// Builds the reply that acknowledges a write: FC 5, 6 and 22 repeat the whole request, FC 15 and 16 its
/// address and quantity.
std::size_t reply_written(Bytes request, Span<std::uint8_t> pdu);

}  // namespace coupler::modbus
