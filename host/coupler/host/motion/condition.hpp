// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "coupler/base/enumeration.hpp"
#include "coupler/codec/value.hpp"
#include "coupler/map/point.hpp"

namespace coupler::host {

enum class Relation : std::uint8_t {
  equal,
  not_equal,
  less,
  at_most,
  greater,
  at_least,
  rises,   ///< a bit becomes 1; a number reaches the value from below
  falls,   ///< a bit becomes 0; a number reaches the value from above
  changes  ///< to any other value
};
constexpr Enumeration<Relation, 9> enumeration(Relation) {
  return {"Relation",
          {{Relation::equal, "equal", "=="},
           {Relation::not_equal, "not_equal", "!="},
           {Relation::less, "less", "<"},
           {Relation::at_most, "at_most", "<="},
           {Relation::greater, "greater", ">"},
           {Relation::at_least, "at_least", ">="},
           {Relation::rises, "rises"},
           {Relation::falls, "falls"},
           {Relation::changes, "changes"}}};
}

/// A condition for the value of a point. All registers are host_registers() of the point, bits as 0
/// or 1.
class Condition {
 public:
  /// `value` is what the point is compared with, as the service `write` takes it. Fails with what is wrong
  /// and the remedy. The storage of the map must outlive the condition.
  static tl::expected<Condition, std::string> parse(const Point& point, std::string_view relation,
                                                    std::string_view value);

  /// Returns whether it is about a change, and not about a value alone.
  bool is_event() const { return relation_ >= Relation::rises; }
  /// Returns whether the value satisfies it. After an event: whether the value is still where the event led
  /// to.
  bool holds(const std::uint16_t* registers) const;
  /// Returns whether the change from one value to the next is the event.
  bool happens(const std::uint16_t* before, const std::uint16_t* now) const;

 private:
  Condition(const Point& point, Relation relation) : point_(&point), relation_(relation) {}
  std::optional<int> compare(const std::uint16_t* registers) const;

  const Point* point_;
  Relation relation_;
  std::vector<codec::Value> value_;  ///< by element; of a point with a scale doubles, as published
};

}  // namespace coupler::host
