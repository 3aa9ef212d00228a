// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/shown_address.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <array>
#include <cstring>

namespace coupler::host {

std::string shown_address(const std::string& listen) {
  if (listen != "0.0.0.0" && listen != "::") return listen;
  std::string found = listen == "::" ? "::1" : "127.0.0.1";
  ifaddrs* first = nullptr;
  if (::getifaddrs(&first) != 0) return found;
  for (const ifaddrs* each = first; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET) continue;
    if ((each->ifa_flags & IFF_LOOPBACK) != 0) continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    sockaddr_in address{};
    std::memcpy(&address, each->ifa_addr, sizeof address);
    found = ::inet_ntop(AF_INET, &address.sin_addr, text.data(), text.size());
    break;
  }
  ::freeifaddrs(first);
  return found;
}

}  // namespace coupler::host
