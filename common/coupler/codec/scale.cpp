// SPDX-License-Identifier: Apache-2.0
#include "coupler/codec/scale.hpp"

#include <array>
#include <limits>
#include <type_traits>

#include "coupler/codec/number.hpp"

namespace coupler::codec {
namespace {

template <class T>
constexpr auto least = static_cast<double>(std::numeric_limits<T>::lowest());
template <class T>
constexpr auto most = static_cast<double>(std::numeric_limits<T>::max());

/// The ends of a 64-bit type are not doubles: `most` is then the first number beyond, which `<` excludes.
template <class T>
bool fits(double raw) {
  if constexpr (std::is_floating_point_v<T>)
    return raw >= least<T> && raw <= most<T>;
  else
    return (raw > least<T> - 0.5 || raw == least<T>)&&raw < most<T> + 0.5;
}

/// Half away from zero. `raw` fits.
template <class T>
T rounded(double raw) {
  if constexpr (std::is_floating_point_v<T>) {
    return static_cast<T>(raw);
  } else {
    const auto whole = static_cast<T>(raw);
    const double rest = raw - static_cast<double>(whole);
    if (rest >= 0.5) return static_cast<T>(whole + 1);
    if (rest <= -0.5) return static_cast<T>(whole - 1);
    return whole;
  }
}

double raw_of(double value, const Scale& scale) { return (value - scale.offset) / scale.gain; }

}  // namespace

double published(const std::uint16_t* registers, const Format& format, const Scale& scale) {
  const double raw = with_number(
      format.type, [&](auto zero) { return static_cast<double>(take<decltype(zero)>(format, registers)); });
  return raw * scale.gain + scale.offset;
}

ScaleError encode_published(double value, const Format& format, const Scale& scale,
                            std::uint16_t* registers) {
  if (value != value) return ScaleError::not_a_number;
  return with_number(format.type, [&](auto zero) {
    using T = decltype(zero);
    const double raw = raw_of(value, scale);
    if (!fits<T>(raw)) return ScaleError::out_of_range;
    put(rounded<T>(raw), format, registers);
    return ScaleError::none;
  });
}

void encode_nearest(double value, const Format& format, const Scale& scale, std::uint16_t* registers) {
  with_number(format.type, [&](auto zero) {
    using T = decltype(zero);
    using Ends = std::numeric_limits<T>;
    const double raw = raw_of(value, scale);
    put(fits<T>(raw) ? rounded<T>(raw) : raw < 0 ? Ends::lowest() : Ends::max(), format, registers);
  });
}

double nearest_published(double value, const Format& format, const Scale& scale) {
  std::array<std::uint16_t, 4> registers{};  // no number has more
  encode_nearest(value, format, scale, registers.data());
  return published(registers.data(), format, scale);
}

PublishedRange published_range(Type type, const Scale& scale) {
  return with_number(type, [&](auto zero) {
    using T = decltype(zero);
    const double a = least<T> * scale.gain + scale.offset;
    const double b = most<T> * scale.gain + scale.offset;
    return a < b ? PublishedRange{a, b} : PublishedRange{b, a};
  });
}

}  // namespace coupler::codec
