// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "device/core/server.hpp"

namespace coupler::node {

/// The core of a node with the memory it needs, all of it taken here.
class Node {
 public:
  /// Both outlive the node.
  Node(const Map& map, Lines& lines, TimePoint now);

  Handler& handler() { return handler_; }
  Server& server() { return server_; }
  Statistics& statistics() { return statistics_; }

 private:
  explicit Node(const Map& map, Lines& lines, TimePoint now, Image::Size size);

  std::vector<Image::Area> areas_;
  std::vector<std::uint16_t> cells_;
  Image image_;
  Statistics statistics_;
  Handler handler_;
  Server server_;
};

}  // namespace coupler::node
