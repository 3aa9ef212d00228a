// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "coupler/map/loader/draft_point.hpp"
#include "coupler/map/loader/reader.hpp"

namespace coupler::loader {

/// Says why a point is not one that a key can name; `what` goes behind its name.
struct Hindrance {
  std::string what;
  std::string remedy;
};

/// The points that a key may name.
struct Eligible {
  std::function<bool(const Point&)> is_meant;  ///< for suggestions
  std::string_view expected;                   ///< "a coil": what to write the name of
  std::function<std::optional<Hindrance>(const DraftPoint&)> why_not;
};

/// The points by name, for keys that name other points.
class PointNames {
 public:
  explicit PointNames(const DraftPoints& points);

  /// The point of that name, or nullptr.
  const DraftPoint* get(std::string_view name) const;

  /// The same. That there is none is a problem, whose remedy is a name that is near, of the points that
  /// `is_meant` finds good, or else to write the name of `expected`.
  const DraftPoint* find(std::string_view name, Position at,
                         const std::function<bool(const Point&)>& is_meant, std::string_view expected,
                         const Context& context) const;

  /// Returns the key's value if it names a point without a hindrance; otherwise that is a problem, unless the
  /// key is absent.
  const Entry* check(const Reader& reader, std::string_view key, const Eligible& eligible,
                     const Context& context) const;

  /// The point of that name in that table, which is one of bits. nullptr if there is none, which is a
  /// problem; `remedy` is for a point in another table.
  const Point* find(std::string_view name, Table table, Position at, std::string remedy,
                    const Context& context) const;

 private:
  std::unordered_map<std::string_view, const DraftPoint*> points_;
};

}  // namespace coupler::loader
