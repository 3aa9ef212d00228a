// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "common/map/loader/load.hpp"

namespace coupler::test {

/// All diagnostics, one a line.
inline std::string text_of(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) text += to_string(diagnostic) + '\n';
  return text;
}

/// The map of a text that must load without a word.
inline MapPtr load_clean(const std::string& text) {
  LoadResult result = load_map(text, "map.yaml");
  EXPECT_EQ(text_of(result.diagnostics), "");
  EXPECT_NE(result.map, nullptr);
  return result.map ? result.map : std::make_shared<OwnedMap>();
}

/// A map of one table, given as the flow text of its points.
inline std::string map_of(const std::string& table, const std::string& points, const std::string& top = "") {
  return "name: press\n" + top + "\nmapping: {" + table + ": {" + points + "}}\n";
}

/// The only point of a table, loaded without a word.
class OnePoint {
 public:
  OnePoint(const std::string& table, const std::string& options, const std::string& top = "")
      : map_(load_clean(map_of(table, "p: " + options, top))) {
    EXPECT_EQ(map_->map().points.size(), 1U);
  }
  const Point* operator->() const { return map_->map().points.empty() ? &none_ : &map_->map().points[0]; }

 private:
  MapPtr map_;
  Point none_;
};

}  // namespace coupler::test
