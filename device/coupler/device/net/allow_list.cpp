// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/net/allow_list.hpp"

#include <algorithm>

#include "coupler/device/net/client_address.hpp"

namespace coupler::device {
bool AllowList::admits(const sockaddr_storage& peer) const {
  if (networks_.empty()) return true;
  const auto address = address_of(peer);
  return address && std::any_of(networks_.begin(), networks_.end(),
                                [&](const Network& network) { return network.contains(*address); });
}

}  // namespace coupler::device
