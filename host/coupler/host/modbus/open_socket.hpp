// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include "coupler/host/core/error.hpp"
#include "coupler/host/modbus/wait.hpp"

namespace coupler::host {

/// A connected TCP socket without Nagle's delay, to the first of the host's addresses that answers. `timeout`
/// is for all attempts together; `interrupt` ends them. Errors: NotConnected with host, port and cause.
Result<Descriptor> open_socket(const std::string& host, std::uint16_t port, std::chrono::milliseconds timeout,
                               const Event& interrupt);

}  // namespace coupler::host
