// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace coupler::modbus {

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

/// Why a reply does not do what the request asked for: the server's exception, or (empty) it does not answer
/// the request.
struct Refused {
  std::optional<Exception> exception;
};

}  // namespace coupler::modbus
