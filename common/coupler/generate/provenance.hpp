// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace coupler::generate {

/// What generated files say of where they come from. No path, no time: the same map gives the same bytes
/// anywhere.
struct Provenance {
  std::string name;     ///< NAME in NAME_map.cpp and coupler::maps::NAME; is_identifier() holds
  std::string source;   ///< the map's file name, without its folder
  std::string version;  ///< of the program that generates
};

}  // namespace coupler::generate
