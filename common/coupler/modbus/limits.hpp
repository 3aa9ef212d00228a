// SPDX-License-Identifier: Apache-2.0
// "Modbus Application Protocol V1.1b3" (MAP) and "Modbus Messaging on TCP/IP Implementation Guide V1.0b"
// (TCP).
#pragma once

#include <cstddef>
#include <cstdint>

namespace coupler::modbus {

constexpr std::uint16_t default_port = 502;

constexpr std::size_t mbap_size = 7;       ///< TCP 3.1.3: MBAP header with the unit id
constexpr std::size_t max_pdu_size = 253;  ///< MAP 4.1
constexpr std::size_t max_adu_size = mbap_size + max_pdu_size;

constexpr std::uint16_t max_read_bits = 2000;            ///< MAP 6.1, 6.2
constexpr std::uint16_t max_read_registers = 125;        ///< MAP 6.3, 6.4
constexpr std::uint16_t max_write_bits = 1968;           ///< MAP 6.11
constexpr std::uint16_t max_write_registers = 123;       ///< MAP 6.12
constexpr std::uint16_t max_read_write_registers = 121;  ///< MAP 6.17: those that FC 23 writes

/// FC 20: a file holds records (registers) 0 … 9999 (MAP 6.14); a reply has room for 124 registers of one
/// group.
constexpr std::uint32_t records_per_file = 10000;
constexpr std::uint16_t max_file_registers = 121;

}  // namespace coupler::modbus
