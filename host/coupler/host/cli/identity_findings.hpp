// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coupler/host/core/identity_check.hpp"

namespace coupler::cli {

/// What a device's identity means for who only looks at it.
struct IdentityFindings {
  struct LeftOut {
    std::uint32_t point;  ///< index into Map::points
    std::string why;
  };
  std::vector<std::string> notes;  ///< for people
  std::vector<LeftOut> left_out;   ///< points whose places mean something else in the device's own map
};

IdentityFindings findings(const Map& map, const host::Identity& identity);

}  // namespace coupler::cli
