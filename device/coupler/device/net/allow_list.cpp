// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/net/allow_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "coupler/device/net/client_address.hpp"

namespace coupler::device {

tl::expected<AllowList, std::string> AllowList::of(const Map& map) {
  std::vector<Network> networks;
  for (const std::string_view text : map.service.allow) {
    const auto network = parse_network(text);
    if (!network)
      return tl::unexpected(
          fmt::format("'allow': '{}' {}; {}", text, network.error().what, network.error().remedy));
    networks.push_back(*network);
  }
  return AllowList(std::move(networks));
}

bool AllowList::admits(const sockaddr_storage& peer) const {
  if (networks_.empty()) return true;
  const auto address = address_of(peer);
  return address && std::any_of(networks_.begin(), networks_.end(),
                                [&](const Network& network) { return network.contains(*address); });
}

}  // namespace coupler::device
