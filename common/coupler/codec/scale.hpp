// SPDX-License-Identifier: Apache-2.0
// Scaled values: what the host publishes, a Float64, <-> registers. No heap, no exceptions.
#pragma once

#include <cstdint>
#include <string_view>

#include "coupler/codec/format.hpp"

namespace coupler::codec {

/// Published value = raw × gain + offset.
struct Scale {
  double gain = 1;  ///< finite, not 0
  double offset = 0;
  /// The point with the exponent n: the host multiplies the gain by 10^n, see map/published.hpp.
  /// The functions of this file take it as 0.
  std::string_view exponent_of{};

  constexpr bool present() const { return gain != 1 || offset != 0 || has_exponent(); }
  constexpr bool has_exponent() const { return !exponent_of.empty(); }
};

/// The types that can be scaled: SINT … ULINT, REAL, LREAL.
constexpr bool is_scalable(Type type) {
  return width(type) >= 8 && type != Type::BYTE && type != Type::WORD && type != Type::DWORD &&
         type != Type::LWORD && type != Type::CHAR;
}

/// The published value of a scalable type's registers. Integers above 2^53 lose their last digits.
double published(const std::uint16_t* registers, const Format& format, const Scale& scale);

enum class ScaleError : std::uint8_t { none, not_a_number, out_of_range };

/// Writes the registers whose published value is nearest to `value`, and leaves other bits of a shared
/// register alone. If there are none, the registers are unchanged.
ScaleError encode_published(double value, const Format& format, const Scale& scale, std::uint16_t* registers);

/// The same for a measurement: a value out of range becomes the nearest end of the range. `value` is not NaN.
void encode_nearest(double value, const Format& format, const Scale& scale, std::uint16_t* registers);

/// Returns what is published after registers have been set to a value as well as they can hold it.
double nearest_published(double value, const Format& format, const Scale& scale);

struct PublishedRange {
  double least;
  double most;
};
/// `format`: of its own, a Type will do: `published_range({Type::INT}, scale)`.
PublishedRange published_range(const Format& format, const Scale& scale);

}  // namespace coupler::codec
