// SPDX-License-Identifier: Apache-2.0
#include "coupler/codec/decimal.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

namespace coupler::codec {
namespace {

/// The digits come from fmt: the fewest that do. Where it puts the point, and when it writes an exponent,
/// differs from release to release.
template <class T>
std::string shortest(T value) {
  const std::string text = fmt::format("{}", std::fabs(value));
  const std::size_t e = std::min(text.find('e'), text.size());
  const std::string mantissa = text.substr(0, e);
  const auto whole = static_cast<int>(std::min(mantissa.find('.'), mantissa.size()));
  std::string digits = mantissa;
  digits.erase(std::remove(digits.begin(), digits.end(), '.'), digits.end());
  const std::size_t first = std::min(digits.find_first_not_of('0'), digits.size());
  // 0.digits × 10^exponent
  int exponent = whole - static_cast<int>(first);
  if (e < text.size()) exponent += std::atoi(text.c_str() + e + 1);
  digits.erase(0, first);
  digits.erase(digits.find_last_not_of('0') + 1);
  const std::string sign = std::signbit(value) ? "-" : "";
  if (digits.empty()) return sign + "0.0";
  const auto count = static_cast<int>(digits.size());
  if (exponent > 16 || exponent < -4)
    return fmt::format("{}{}.{}e{}", sign, digits[0], count > 1 ? digits.substr(1) : "0", exponent - 1);
  if (exponent <= 0) return sign + "0." + std::string(static_cast<std::size_t>(-exponent), '0') + digits;
  if (count <= exponent) return sign + digits.append(static_cast<std::size_t>(exponent - count), '0') + ".0";
  return sign + digits.insert(static_cast<std::size_t>(exponent), ".");
}

}  // namespace

std::string decimal(double value) { return shortest(value); }
std::string decimal(float value) { return shortest(value); }

}  // namespace coupler::codec
