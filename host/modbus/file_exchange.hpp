// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "common/modbus/file_record.hpp"
#include "host/core/error.hpp"

namespace coupler::driver {

/// One FC 20 request and its reply on a connected, non-blocking socket: libmodbus cannot receive it.
Result<> exchange_file_record(int socket, std::uint8_t unit, std::chrono::milliseconds timeout,
                              modbus::FileRecord wanted, Span<std::uint16_t> registers);

}  // namespace coupler::driver
