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

/// The largest value of the type, or that the format has bits for.
template <class T>
T largest(const Format& format) {
  if constexpr (may_be_partial<T>)
    if (format.bits != 0) return static_cast<T>(largest_in(format.bits));
  return std::numeric_limits<T>::max();
}

/// The ends of a 64-bit type are not doubles: `largest` is then the first number beyond, which `<` excludes.
template <class T>
bool fits(double raw, const Format& format) {
  const auto most = static_cast<double>(largest<T>(format));
  if constexpr (std::is_floating_point_v<T>)
    return raw >= least<T> && raw <= most;
  else
    return (raw > least<T> - 0.5 || raw == least<T>)&&raw < most + 0.5;
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
    if (!fits<T>(raw, format)) return ScaleError::out_of_range;
    put(rounded<T>(raw), format, registers);
    return ScaleError::none;
  });
}

void encode_nearest(double value, const Format& format, const Scale& scale, std::uint16_t* registers) {
  with_number(format.type, [&](auto zero) {
    using T = decltype(zero);
    const double raw = raw_of(value, scale);
    const T end = raw < 0 ? std::numeric_limits<T>::lowest() : largest<T>(format);
    put(fits<T>(raw, format) ? rounded<T>(raw) : end, format, registers);
  });
}

double nearest_published(double value, const Format& format, const Scale& scale) {
  std::array<std::uint16_t, 4> registers{};  // no number has more
  encode_nearest(value, format, scale, registers.data());
  return published(registers.data(), format, scale);
}

PublishedRange published_range(const Format& format, const Scale& scale) {
  return with_number(format.type, [&](auto zero) {
    using T = decltype(zero);
    const double a = least<T> * scale.gain + scale.offset;
    const double b = static_cast<double>(largest<T>(format)) * scale.gain + scale.offset;
    return a < b ? PublishedRange{a, b} : PublishedRange{b, a};
  });
}

}  // namespace coupler::codec
