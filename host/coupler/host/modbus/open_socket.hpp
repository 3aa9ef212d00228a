// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "coupler/host/core/error.hpp"
#include "coupler/host/core/wakeup.hpp"

struct addrinfo;

namespace coupler::host {

/// A connected TCP socket without Nagle's delay, to the first of the host's addresses that answers. `timeout`
/// is for all attempts together; `interrupt` ends them. Errors: NotConnected with host, port and cause.
Result<Descriptor> open_socket(const std::string& host, std::uint16_t port, std::chrono::milliseconds timeout,
                               const Event& interrupt);

/// Returns whether there is something to read, or the end, without waiting.
bool is_readable(int fd);

// Parts of open_socket().

/// The same for addresses that are known, one after the other: each has an equal share of the time that is
/// left, so that one which is silent does not keep the others from being tried. Errors begin with `where`;
/// addresses that fail for different reasons are named, each with its own.
Result<Descriptor> connect_to_one(const addrinfo* addresses, const std::string& where,
                                  const Deadline& deadline, const Event& interrupt);

/// Why there is no address of a host, and what to do. `status`: getaddrinfo()'s; nullopt: no answer.
NotConnected lookup_failure(const std::string& host, std::optional<int> status);

}  // namespace coupler::host
