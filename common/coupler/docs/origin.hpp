// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace coupler::docs {

/// What the pages say of where they come from. No time and no folder of this machine: the same map gives the
/// same bytes anywhere.
struct Origin {
  std::string file;     ///< the map's file name, without its folder
  std::string url;      ///< where a reader finds the file, to which "#L12" is added; empty: no links
  std::string version;  ///< of the program that makes them
};

}  // namespace coupler::docs
