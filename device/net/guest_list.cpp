// SPDX-License-Identifier: Apache-2.0
#include "device/net/guest_list.hpp"

#include <netinet/in.h>

#include <algorithm>
#include <cstring>
#include <optional>

namespace coupler::node {
namespace {

std::optional<IpAddress> address_of(const sockaddr_storage& peer) {
  IpAddress address{};
  if (peer.ss_family == AF_INET6) {
    const auto& ipv6 = reinterpret_cast<const sockaddr_in6&>(peer);
    std::memcpy(address.data(), &ipv6.sin6_addr, address.size());
    return address;
  }
  if (peer.ss_family != AF_INET) return std::nullopt;
  const auto& ipv4 = reinterpret_cast<const sockaddr_in&>(peer);
  address[10] = address[11] = 0xFF;
  std::memcpy(&address[12], &ipv4.sin_addr, 4);
  return address;
}

}  // namespace

bool GuestList::admits(const sockaddr_storage& peer) const {
  if (networks_.empty()) return true;
  const auto address = address_of(peer);
  return address && std::any_of(networks_.begin(), networks_.end(),
                                [&](const Network& network) { return network.contains(*address); });
}

}  // namespace coupler::node
