// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "coupler/map/map.hpp"

namespace coupler {

/// A field of canonical_line() that is not the same: "address", "5", "7".
struct FieldChange {
  std::string_view field;  ///< constant text
  std::string older;
  std::string newer;
};

/// The difference of one point between two maps.
struct Difference {
  enum class Kind { missing, added, changed };  ///< missing: in the old map only; added: in the new map only
  Kind kind;
  std::string point;
  std::string what;  ///< "address 5 -> 7, type INT -> UINT"; for missing and added the point's place and type
  std::vector<FieldChange> fields{};  ///< of changed: those of `what`, at least one
};

/// A driver that knows the old map cannot go on with the new one: every difference but an added point. The
/// one place of this rule: the check at connect and everything that judges two maps ask here.
constexpr bool is_breaking(Difference::Kind kind) { return kind != Difference::Kind::added; }

/// The differences that both sides of a connection must agree on (the fields of canonical_line()), in the
/// order of the old map, then what was added. Points are matched by name.
std::vector<Difference> diff(const Map& older, const Map& newer);

/// Everything that `known` says is unchanged in `device`, which may have more: the driver may go on.
bool is_subset(const Map& known, const Map& device);

/// One line: "- gripper: missing (coils 3, BOOL)".
std::string to_string(const Difference& difference);

}  // namespace coupler
