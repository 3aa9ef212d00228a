// SPDX-License-Identifier: Apache-2.0
#include "device/node/node.hpp"

namespace coupler::node {

Node::Node(const Map& map, Lines& lines, TimePoint now) : Node(map, lines, now, Image::size_for(map)) {}

Node::Node(const Map& map, Lines& lines, TimePoint now, Image::Size size)
    : areas_(size.areas),
      cells_(size.cells),
      image_(map, areas_, cells_),
      handler_(map, image_, lines, statistics_),
      server_(map.connection.unit, handler_, statistics_) {
  statistics_.started = now;
}

}  // namespace coupler::node
