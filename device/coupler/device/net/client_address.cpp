// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/net/client_address.hpp"

#include <netdb.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace coupler::device {
namespace {

constexpr std::size_t ipv6_network = 8;  ///< bytes of the /64

}  // namespace

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

IpAddress origin_of(const sockaddr_storage& peer) {
  IpAddress origin = address_of(peer).value_or(IpAddress{});
  if (!is_ipv4(origin)) std::fill(origin.begin() + ipv6_network, origin.end(), std::uint8_t{0});
  return origin;
}

std::string host_of(const sockaddr_storage& peer) {
  std::array<char, NI_MAXHOST> host{};
  if (::getnameinfo(reinterpret_cast<const sockaddr*>(&peer), sizeof peer, host.data(), host.size(), nullptr,
                    0, NI_NUMERICHOST) != 0)
    return "a client";
  return host.data();
}

}  // namespace coupler::device
