// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/motion/condition.hpp"

#include <cmath>
#include <type_traits>
#include <variant>

#include <fmt/format.h>

#include "coupler/host/core/value_text.hpp"
#include "coupler/map/printable.hpp"
#include "coupler/map/published.hpp"

namespace coupler::host {
namespace {

using codec::Type;
using codec::Value;

enum class Kind { bit, number, other };

Kind kind_of(const Point& point) {
  if (point.count > 1 || point.format.type == Type::STRING || point.format.type == Type::CHAR)
    return Kind::other;
  return point.format.type == Type::BOOL ? Kind::bit : Kind::number;
}

bool is_ordered(Relation relation) { return relation >= Relation::less && relation <= Relation::falls; }

/// The relations that go with a kind of point, for messages.
std::string_view relations_of(Kind kind) {
  switch (kind) {
    case Kind::bit: return "==, !=, rises, falls or changes";
    case Kind::number: return "==, !=, <, <=, >, >=, rises, falls or changes";
    case Kind::other: break;
  }
  return "==, != or changes";
}

/// A point that is not scaled holds no fraction; what it is compared with may have one.
Point published_number(const Point& point) {
  Point number;
  number.name = point.name;
  number.table = Table::holding_registers;
  number.format.type = Type::LREAL;
  number.count = point.count;
  return number;
}

std::size_t registers_of(const Point& point) { return codec::registers(point.format); }

Value element(const std::uint16_t* registers, const Point& point) {
  if (holds_bits(point.table)) return registers[0] != 0;
  if (point.scale.present()) return published(registers, point);
  return codec::decode(registers, point.format);
}

/// Scaled numbers that are nearer to each other than the rounding of the scale, or than the steps of an
/// integer, are equal: 217 x 0.1 is 21.7.
double least_difference(const std::uint16_t* registers, const Point& point, const Value& value) {
  if (!point.scale.present()) return 0;
  if (codec::is_float(point.format.type)) return std::abs(std::get<double>(value)) * 1e-12;
  return std::abs(scale_of(registers, point).gain) * 1e-6;
}

/// Nothing if one of them is no number (NaN).
std::optional<int> compare_numbers(const Value& a, const Value& b, double least) {
  return std::visit(
      [&](const auto& x) -> std::optional<int> {
        using T = std::decay_t<decltype(x)>;
        const T* y = std::get_if<T>(&b);
        if (y == nullptr) return std::nullopt;
        if constexpr (std::is_floating_point_v<T>) {
          if (std::isnan(x) || std::isnan(*y)) return std::nullopt;
          if (x != *y && std::abs(static_cast<double>(x) - static_cast<double>(*y)) < least) return 0;
        }
        return x < *y ? -1 : x > *y ? 1 : 0;
      },
      a);
}

}  // namespace

tl::expected<Condition, std::string> Condition::parse(const Point& point, std::string_view word,
                                                      std::string_view text) {
  const Kind kind = kind_of(point);
  const auto relation = parse_word<Relation>(word);
  if (!relation)
    return tl::unexpected(
        word.empty() ? fmt::format("the goal has no condition; send {}", relations_of(kind))
                     : fmt::format("{} is no condition; send {}", excerpt(word), relations_of(kind)));
  const bool is_event = *relation >= Relation::rises;
  if (is_ordered(*relation) && (kind == Kind::other || (kind == Kind::bit && !is_event)))
    return tl::unexpected(fmt::format("'{}' does not go with {}, which is {}; send {}", word, point.name,
                                      kind == Kind::bit ? "a bit" : (point.count > 1 ? "an array" : "a text"),
                                      relations_of(kind)));
  Condition condition(point, *relation);
  const bool takes_value = !is_event || (kind == Kind::number && *relation != Relation::changes);
  if (!takes_value) {
    if (!text.empty())
      return tl::unexpected(
          fmt::format("'{}' of {} takes no value, but {} was sent; leave it out, or send '=='", word,
                      point.name, excerpt(text)));
    return condition;
  }
  if (text.empty() && kind != Kind::other)
    return tl::unexpected(
        fmt::format("'{}' of {} needs a value to compare with; send one", word, point.name));

  const bool scaled = point.scale.present();
  const Point as = scaled ? published_number(point) : point;
  std::vector<std::uint16_t> registers(point.count * registers_of(as));
  if (const auto parsed = parse_value(text, as, registers.data()); !parsed)
    return tl::unexpected(parsed.error());
  for (std::size_t i = 0; i < point.count; ++i)
    condition.value_.push_back(element(&registers[i * registers_of(as)], as));
  return condition;
}

/// Returns the order of the first element that differs; 0 if none does.
std::optional<int> Condition::compare(const std::uint16_t* registers) const {
  for (std::size_t i = 0; i < value_.size(); ++i) {
    const auto order = compare_numbers(element(registers + i * registers_of(*point_), *point_), value_[i],
                                       least_difference(registers, *point_, value_[i]));
    if (!order || *order != 0) return order;
  }
  return 0;
}

bool Condition::holds(const std::uint16_t* registers) const {
  if (relation_ == Relation::changes) return true;
  if (value_.empty()) return (registers[0] != 0) == (relation_ == Relation::rises);
  const auto order = compare(registers);
  if (!order) return relation_ == Relation::not_equal;
  switch (relation_) {
    case Relation::equal: return *order == 0;
    case Relation::not_equal: return *order != 0;
    case Relation::less: return *order < 0;
    case Relation::falls:
    case Relation::at_most: return *order <= 0;
    case Relation::greater: return *order > 0;
    case Relation::rises:
    case Relation::at_least: return *order >= 0;
    case Relation::changes: break;
  }
  return false;
}

bool Condition::happens(const std::uint16_t* before, const std::uint16_t* now) const {
  if (relation_ == Relation::changes) return true;
  return compare(before) && !holds(before) && holds(now);  // no number (NaN) was on neither side
}

}  // namespace coupler::host
