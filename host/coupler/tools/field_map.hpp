// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coupler/map/map.hpp"

namespace coupler::tools {

/// The map of a simulated node's field side (coupler/map/field_side.hpp): what the node reads can be written,
/// unless a wire or a counter gives it its value, and what the node drives can be read.
class FieldMap {
 public:
  /// The storage of `node` must outlive it.
  explicit FieldMap(const Map& node);
  FieldMap(const FieldMap&) = delete;
  FieldMap& operator=(const FieldMap&) = delete;

  const Map& map() const { return map_; }

  /// Asks the node once. Empty: it has such a side; otherwise why not, and what to do.
  std::string why_missing() const;

 private:
  const Connection node_;
  std::vector<Point> points_;
  Map map_;
};

}  // namespace coupler::tools
