// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>

#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "coupler/map/map.hpp"
#include "coupler/map/network.hpp"

namespace coupler::device {

/// The networks that may connect; an empty list admits everyone.
class AllowList {
 public:
  AllowList() = default;
  explicit AllowList(std::vector<Network> networks) : networks_(std::move(networks)) {}

  /// The list of the map's `allow`. The error names what is not an address.
  static tl::expected<AllowList, std::string> of(const Map& map);

  bool admits(const sockaddr_storage& peer) const;

 private:
  std::vector<Network> networks_;
};

}  // namespace coupler::device
