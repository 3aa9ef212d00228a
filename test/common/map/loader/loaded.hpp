// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "coupler/map/loader/load.hpp"

namespace coupler::test {

/// All diagnostics, one a line.
std::string text_of(const Diagnostics& diagnostics);

/// The map of a text that must load without a word.
MapPtr load_clean(const std::string& text);

/// A map of one table, given as the flow text of its points.
std::string map_of(const std::string& table, const std::string& points, const std::string& top = "");

/// The map of a coil and of these keys beside it, which must load without a word.
MapPtr load_with(const std::string& top);

/// With a lock in a file of that text, or none.
LoadResult load_with_lock(const std::string& text, LockUse use,
                          std::optional<std::string> lock = std::nullopt);

/// The same, which must load without a word.
LoadResult renewed(const std::string& text, std::optional<std::string> lock = std::nullopt);

/// The only point of a table, loaded without a word.
class OnePoint {
 public:
  OnePoint(const std::string& table, const std::string& options, const std::string& top = "");
  const Point* operator->() const { return map_->map().points.empty() ? &none_ : &map_->map().points[0]; }

 private:
  MapPtr map_;
  Point none_;
};

}  // namespace coupler::test
