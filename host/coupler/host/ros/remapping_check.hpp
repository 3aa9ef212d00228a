// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace coupler::host {

struct Remapping {
  std::string from;  ///< as it was given
  std::string to;
};

/// Finds remappings of topics and services that change nothing: ROS takes any.
class RemappingCheck {
 public:
  /// Nothing is remapped.
  RemappingCheck() = default;
  /// `space`: the namespace of this node, "/" or "/cell".
  RemappingCheck(std::vector<Remapping> given, std::string space);

  /// The node has a topic or a service of this name, which is relative and before any remapping.
  void add_name(const std::string& name, bool is_a_points) {
    if (!given_.empty()) names_.emplace(name, is_a_points);
  }

  /// A line for each that is none of these names and was meant to be: it begins with the name of one of
  /// `devices`, or something near is one of them. Others are for another node, which is often given the same.
  std::vector<std::string> unused(const std::vector<std::string>& devices) const;

 private:
  std::string relative(const std::string& name) const;
  std::string meant(const std::string& name, const std::vector<std::string>& devices) const;

  std::vector<Remapping> given_;
  std::string space_;                            ///< with '/' at its end
  std::unordered_map<std::string, bool> names_;  ///< whether it is a point's
};

}  // namespace coupler::host
