// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <netdb.h>

#include <memory>
#include <string>

#include "coupler/host/core/error.hpp"
#include "coupler/host/modbus/deadline.hpp"
#include "coupler/host/modbus/event.hpp"

namespace coupler::host {

using Addresses = std::unique_ptr<addrinfo, void (*)(addrinfo*)>;

/// The addresses of a host name or of an address in numbers. Asking a name server cannot be broken off, so a
/// thread of its own does it, which is left behind when `interrupt` or the deadline comes first.
Result<Addresses> resolve(const std::string& host, std::uint16_t port, Deadline deadline,
                          const Event& interrupt);

}  // namespace coupler::host
