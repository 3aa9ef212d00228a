// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "coupler/map/diagnostic.hpp"
#include "coupler/map/map.hpp"

namespace coupler::formats {

/// What an export leaves out, and of which points.
class ConversionWarnings {
 public:
  /// `what` ends as in "units are comments only"; the same one of several points is told once.
  void add(std::string_view what, std::string_view remedy, std::string_view point = {});

  /// One warning each, about `file`: "units are comments only: speed, level".
  Diagnostics diagnostics(std::string_view file) const;

 private:
  struct ConversionWarning {
    std::string what;
    std::string remedy;
    std::vector<std::string> points;
  };
  std::vector<ConversionWarning> warnings_;
};

/// What only a node or this project's driver makes use of, and no program that reads a device has a word for.
void add_sides(const Map& map, ConversionWarnings& warnings);

}  // namespace coupler::formats
