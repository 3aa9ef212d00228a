// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "common/map/table.hpp"
#include "common/modbus/frame.hpp"
#include "common/modbus/range.hpp"
#include "host/core/error.hpp"

namespace coupler::driver {

/// libmodbus keeps exception codes above 0B to itself: the read that was answered with one is made once more,
/// on the same socket with the header `to`, for its code alone. Code 0 if it is answered with values now.
Result<modbus::Exception> ask_for_exception(int socket, const modbus::Frame& to,
                                            std::chrono::milliseconds timeout, Table table,
                                            modbus::Range range);

}  // namespace coupler::driver
