// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>

#include "coupler/map/loader/reader.hpp"

namespace coupler::loader {

/// A section of the map whose elements are joints.
struct JointKind {
  std::string_view key;  ///< "tools"
  std::string_view one;  ///< "tool"
  std::string_view an;   ///< "a tool"
};
constexpr JointKind tool_kind{"tools", "tool", "a tool"};
constexpr JointKind axis_kind{"axes", "axis", "an axis"};

/// The names of a map's tools and axes. Each has one of its own, and is a joint with a name of its own, which
/// MoveIt knows it by.
class Joints {
 public:
  explicit Joints(const Context& context) : context_(context) {}

  /// The tools or axes, in the order of the file; none if `tools` or `axes` is absent or wrong as a whole.
  Span<const Entry> entries(const JointKind& kind, const Reader& top) const;

  /// The name of the next one. False if it is wrong.
  bool check_name(const JointKind& kind, const Entry& entry);

  /// Its name as a joint, `usual` if the map gives none. `reader` has the keys of `entry`.
  void check_joint(const JointKind& kind, const Reader& reader, const Entry& entry, const std::string& usual);

 private:
  /// A tool or an axis that stands before.
  struct Taken {
    std::string name;
    JointKind kind;
    Position at;
  };

  const Context& context_;
  std::unordered_map<std::string, Taken> names_;
  std::unordered_map<std::string, Taken> joints_;
};

}  // namespace coupler::loader
