// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "coupler/map/loader/problems.hpp"
#include "coupler/map/owned_map.hpp"

namespace coupler::loader {

/// What all readers of one file share.
struct Context {
  Problems& problems;
  OwnedMap& map;                   ///< keeps the texts that points refer to
  std::string_view name{};         ///< of a map that says none; empty: it has to
  std::vector<int> point_lines{};  ///< LoadResult::point_lines
  Position filled_in{};            ///< where the first point stands whose address the text leaves out
  bool origin = false;  ///< may_be_of_the_origin: what ros-modbus-device-driver would ignore is a warning
  bool served = false;  ///< by a node, which may be newer than this program: it knows more keys

  void ignored(Position at, std::string what, std::string remedy) {
    if (origin || served)
      problems.warning(at, what + ", ignored", std::move(remedy));
    else
      problems.error(at, std::move(what), std::move(remedy));
  }
};

}  // namespace coupler::loader
