// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>

#include <optional>
#include <string>

#include "coupler/map/network.hpp"

namespace coupler::device {

/// The address of a connected socket's other end; an IPv4 address as IPv6 has it (::ffff:10.0.0.7). nullopt:
/// it has no IP address.
std::optional<IpAddress> address_of(const sockaddr_storage& peer);

/// Returns what counts as one client when connections are shared out: an IPv4 address, or the /64 of an IPv6
/// address, since a machine can choose freely among the 2^64 addresses of its network.
IpAddress origin_of(const sockaddr_storage& peer);

/// The address of a client as text; "a client" if it has none.
std::string host_of(const sockaddr_storage& peer);

}  // namespace coupler::device
