// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>

#include <utility>
#include <vector>

#include "coupler/map/network.hpp"

namespace coupler::device {

/// Who may connect; an empty list lets everyone in.
class AllowList {
 public:
  AllowList() = default;
  explicit AllowList(std::vector<Network> networks) : networks_(std::move(networks)) {}

  bool admits(const sockaddr_storage& peer) const;

 private:
  std::vector<Network> networks_;
};

}  // namespace coupler::device
