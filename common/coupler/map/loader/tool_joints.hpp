// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>

#include "coupler/map/loader/reader.hpp"

namespace coupler::loader {

/// The names of a map's tools as joints: each has one of its own, which MoveIt knows it by.
class ToolJoints {
 public:
  ToolJoints(const Map& head, const Context& context) : head_(head), context_(context) {}

  /// The next tool, at `entry`; `reader` has its keys.
  void check(const Reader& reader, const Entry& entry, const Tool& tool);

 private:
  /// The joint of a tool that stands before.
  struct Taken {
    std::string_view tool;
    Position at;
  };

  const Map& head_;
  const Context& context_;
  std::unordered_map<std::string, Taken> taken_;
};

/// Checks that the two ends have different positions: otherwise a goal could not tell them apart.
void check_positions(const Reader& reader, const Tool& tool, const Context& context);

}  // namespace coupler::loader
