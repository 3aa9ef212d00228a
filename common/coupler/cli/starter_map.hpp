// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace coupler::cli {

/// What a first map is to begin with.
struct Starter {
  std::string name;     ///< of the device
  std::string address;  ///< of a coupler; a node has none in its map
  std::string preset;   ///< the coupler's kind; empty: any
  bool node = false;    ///< a board with GPIO lines that coupler-node serves
  std::string schema;   ///< what an editor checks it with, as seen from the map's folder
};

/// A map with an example of what people need first, each line explained. It passes `coupler check`.
std::string starter_map(const Starter& starter);

}  // namespace coupler::cli
