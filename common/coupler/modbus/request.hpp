// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <tl/expected.hpp>
#include <variant>

#include "coupler/modbus/bytes.hpp"
#include "coupler/modbus/device_identification.hpp"
#include "coupler/modbus/exception.hpp"
#include "coupler/modbus/file_record.hpp"
#include "coupler/modbus/function.hpp"
#include "coupler/modbus/range.hpp"

namespace coupler::modbus {

// What a client can ask for. Bytes are views of the request's PDU.

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

using Request = std::variant<Echo, FileGroups, Read, ReadDeviceIdentification, WriteBits, WriteRegisters,
                             MaskWrite, ReadWriteRegisters>;

/// Reads a request PDU of at least one byte and checks all that can be checked without knowing the device, in
/// the order of MAP's state diagrams. Errors: 01 a function or one of its sub-functions that is not spoken
/// here, or a code of 128 and above; 03 a PDU longer or shorter than it must be, a quantity outside its
/// limits, a byte count that does not match it, a coil value other than 0x0000 and 0xFF00; 02 a range that
/// runs past address 65535.
tl::expected<Request, Exception> parse_request(Bytes pdu);

}  // namespace coupler::modbus
