// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "coupler/host/core/error.hpp"
#include "coupler/modbus/file_record.hpp"
#include "coupler/modbus/frame.hpp"

namespace coupler::host {

/// One FC 20 request and its reply on a connected, non-blocking socket: libmodbus cannot receive it. `to` is
/// the header to use.
Result<> exchange_file_record(int socket, const modbus::Frame& to, std::chrono::milliseconds timeout,
                              modbus::FileRecord wanted, Span<std::uint16_t> registers);

}  // namespace coupler::host
