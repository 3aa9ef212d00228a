// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "coupler/codec/number.hpp"
#include "coupler/codec/scale.hpp"
#include "coupler/map/allowed_values.hpp"
#include "coupler/tools/formats/structured_text.hpp"

namespace coupler::formats::structured_text {
namespace {

using codec::Type;
using Registers = std::array<std::uint16_t, 4>;  // no number has more

/// No key limits its values, and 0 is no number that a scale could move.
bool is_unlimited(const Point& point) {
  return holds_bits(point.table) || !codec::is_scalable(point.format.type);
}

/// The registers nearest to a bound.
Registers at_bound(double value, const Point& point) {
  Registers registers{};
  codec::encode_nearest(value, point.format, point.scale, registers.data());
  return registers;
}

/// "> 2.5": all that is rounded to `least` or more. A half itself is left out, since not all PLCs round it to
/// the same side.
template <class T>
std::string above(T least) {
  const auto end = static_cast<double>(least);
  double middle = end;
  if constexpr (std::is_integral_v<T>)
    middle -= 0.5;
  else if (std::is_same_v<T, float> && least != std::numeric_limits<T>::lowest())
    middle = (end + static_cast<double>(std::nextafter(least, std::numeric_limits<T>::lowest()))) / 2;
  return middle == end ? ">= " + lreal(end) : "> " + lreal(middle);
}

template <class T>
std::string below(T most) {
  constexpr T last = std::numeric_limits<T>::max();
  const auto end = static_cast<double>(most);
  double middle = end;
  if constexpr (std::is_integral_v<T>)
    middle += 0.5;
  else if (std::is_same_v<T, float> && most != last)
    middle = (end + static_cast<double>(std::nextafter(most, last))) / 2;
  // The last integer of 64 bits becomes the first one beyond as an LREAL.
  const bool is_beyond = std::is_integral_v<T> && most == last;
  return middle == end && !is_beyond ? "<= " + lreal(end) : "< " + lreal(middle);
}

}  // namespace

// Checks a value as the driver does (coupler/map/allowed_values.cpp): the value that the registers would hold
// has to be between those nearest to the bounds. A comparison with NaN is false.
std::string allowed(const Point& point, const std::string& variable) {
  const Registers min = at_bound(point.bounds.min, point);
  const Registers max = at_bound(point.bounds.max, point);
  if (point.scale.present()) {
    return codec::with_number(point.format.type, [&](auto zero) {
      using T = decltype(zero);
      const T a = codec::take<T>(point.format, min.data());
      const T b = codec::take<T>(point.format, max.data());  // below the other one if the gain is negative
      return fmt::format("(raw {}) AND (raw {})", above<T>(std::min(a, b)), below<T>(std::max(a, b)));
    });
  }
  const auto literal = [&](const Registers& registers) {
    std::string text = number(point, registers.data());
    if (point.format.type == Type::REAL) text.insert(text.front() == '-' ? 1 : 0, "REAL#");
    return text;
  };
  return fmt::format("({0} >= {1}) AND ({0} <= {2})", variable, literal(min), literal(max));
}

bool may_be_zero(const Point& point) {
  if (is_unlimited(point)) return true;
  Registers zero{};
  return codec::encode_published(0, point.format, point.scale, zero.data()) == codec::ScaleError::none &&
         !why_forbidden(point, zero.data());
}

std::vector<std::uint16_t> start_registers(const Point& point) {
  std::vector<std::uint16_t> registers(point.initial.begin(), point.initial.end());
  registers.resize(range(point).count());
  if (!point.initial.empty() || is_unlimited(point)) return registers;
  const auto is_nearer = [](const NamedValue& a, const NamedValue& b) {
    return std::fabs(static_cast<double>(a.value)) < std::fabs(static_cast<double>(b.value));
  };
  for (std::size_t i = 0; i < point.count; ++i) {
    std::uint16_t* value = registers.data() + i * codec::registers(point.format);
    if (point.values.empty()) {
      const double start = std::clamp(0.0, point.bounds.min, point.bounds.max);
      codec::encode_nearest(start, point.format, point.scale, value);
    } else {
      const auto* named = std::min_element(point.values.begin(), point.values.end(), is_nearer);
      codec::with_number(point.format.type, [&](auto zero) {
        codec::put(static_cast<decltype(zero)>(named->value), point.format, value);
      });
    }
  }
  return registers;
}

}  // namespace coupler::formats::structured_text
