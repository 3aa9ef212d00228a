// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>

#include <optional>

#include "coupler/map/network.hpp"

namespace coupler::device {

/// The address of a connected socket's other end; an IPv4 address as IPv6 has it (::ffff:10.0.0.7). nullopt:
/// it has no IP address.
std::optional<IpAddress> address_of(const sockaddr_storage& peer);

/// What counts as one client where places are shared out: an IPv4 address, or the /64 of an IPv6 address. A
/// machine can choose freely among the 2^64 addresses of its network.
IpAddress origin_of(const sockaddr_storage& peer);

}  // namespace coupler::device
