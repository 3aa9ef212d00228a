// SPDX-License-Identifier: Apache-2.0
// What every PDU consists of ("Modbus Application Protocol V1.1b3", MAP, 4 to 7).
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "coupler/base/span.hpp"

namespace coupler::modbus {

using Bytes = Span<const std::uint8_t>;

/// Modbus is big endian (MAP 4.2).
constexpr std::uint16_t get_u16(const std::uint8_t* at) {
  return static_cast<std::uint16_t>(at[0] << 8 | at[1]);
}
constexpr void put_u16(std::uint8_t* at, std::uint16_t value) {
  at[0] = static_cast<std::uint8_t>(value >> 8);
  at[1] = static_cast<std::uint8_t>(value);
}
constexpr std::uint32_t get_u32(const std::uint8_t* at) {
  return std::uint32_t{get_u16(at)} << 16 | get_u16(at + 2);
}
constexpr void put_u32(std::uint8_t* at, std::uint32_t value) {
  put_u16(at, static_cast<std::uint16_t>(value >> 16));
  put_u16(at + 2, static_cast<std::uint16_t>(value));
}
constexpr std::uint64_t get_u64(const std::uint8_t* at) {
  return std::uint64_t{get_u32(at)} << 32 | get_u32(at + 4);
}
constexpr void put_u64(std::uint8_t* at, std::uint64_t value) {
  put_u32(at, static_cast<std::uint32_t>(value >> 32));
  put_u32(at + 4, static_cast<std::uint32_t>(value));
}

/// The function codes in use here. 65 and 66 are our own, from the range that MAP 5.1 leaves to users.
enum class Function : std::uint8_t {
  read_coils = 1,
  read_discrete_inputs = 2,
  read_holding_registers = 3,
  read_input_registers = 4,
  write_single_coil = 5,
  write_single_register = 6,
  diagnostics = 8,
  write_multiple_coils = 15,
  write_multiple_registers = 16,
  read_file_record = 20,
  mask_write_register = 22,
  read_write_multiple_registers = 23,
  encapsulated_interface = 43,
  wait_for_changes = 65,
  schedule_output = 66,
};

/// Set in the function code of a reply that is an exception (MAP 4.1). Function codes are 1 … 127.
constexpr std::uint8_t exception_bit = 0x80;

/// Exception codes (MAP 7). Devices send others too: any value may arrive.
enum class Exception : std::uint8_t {
  illegal_function = 1,
  illegal_data_address = 2,
  illegal_data_value = 3,
  server_device_failure = 4,
  acknowledge = 5,
  server_device_busy = 6,
  memory_parity_error = 8,
  gateway_path_unavailable = 0x0A,
  gateway_target_failed_to_respond = 0x0B,
};

constexpr std::string_view to_string(Exception code) {
  switch (code) {
    case Exception::illegal_function: return "illegal function";
    case Exception::illegal_data_address: return "illegal data address";
    case Exception::illegal_data_value: return "illegal data value";
    case Exception::server_device_failure: return "server device failure";
    case Exception::acknowledge: return "acknowledge";
    case Exception::server_device_busy: return "server device busy";
    case Exception::memory_parity_error: return "memory parity error";
    case Exception::gateway_path_unavailable: return "gateway path unavailable";
    case Exception::gateway_target_failed_to_respond: return "gateway target failed to respond";
  }
  return "unknown exception";
}

/// Why a reply is not the expected one: the server's exception, or another value than was written (FC 5 and 6
/// repeat it), or (empty) it does not match the request.
struct ReplyError {
  std::optional<Exception> exception{};
  std::optional<std::uint16_t> other_value{};
};
constexpr ReplyError reply_error(std::uint8_t function, Bytes reply) {
  if (reply.size() != 2 || reply[0] != (function | exception_bit)) return {};
  return {static_cast<Exception>(reply[1])};
}

}  // namespace coupler::modbus
