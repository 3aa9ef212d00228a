// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/scan/known_value.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>

#include <fmt/format.h>

#include "coupler/map/loader/names.hpp"
#include "coupler/map/loader/scalar.hpp"

namespace coupler::scan {
namespace {

/// Half of the last digit: of "230.4" 0.05, of "12e3" 500.
double exactness(std::string_view number) {
  const auto exponent_at = std::min(number.find_first_of("eE"), number.size());
  const std::string_view digits = number.substr(0, exponent_at);
  const auto point = digits.find('.');
  const double decimals =
      point == std::string_view::npos ? 0 : static_cast<double>(digits.size() - point - 1);
  const auto exponent =
      exponent_at < number.size() ? loader::parse_number(number.substr(exponent_at + 1)).value_or(0) : 0;
  return 0.5 * std::pow(10, exponent - decimals);
}

}  // namespace

tl::expected<KnownValue, std::string> parse_known_value(std::string_view text) {
  KnownValue known;
  std::string_view number = text;
  if (const auto equals = text.find('='); equals != std::string_view::npos) {
    known.name = text.substr(0, equals);
    number = text.substr(equals + 1);
    if (!loader::is_relative_ros_name(known.name) || known.name == "online" || known.name == "status")
      return tl::make_unexpected(fmt::format(
          "'{}' cannot be a point's name; write a letter, then letters, digits and '_'", known.name));
  }
  std::optional<double> tolerance;
  for (const std::string_view sign : {"±", "+-"})
    if (const auto at = number.find(sign); at != std::string_view::npos) {
      tolerance = loader::parse_number(number.substr(at + sign.size()));
      number = number.substr(0, at);
      if (!tolerance || *tolerance < 0)
        return tl::make_unexpected(
            fmt::format("the tolerance in '{}' is not a number; write 230.4±0.5", text));
    }
  const auto value = loader::parse_number(number);
  if (!value)
    return tl::make_unexpected(
        fmt::format("'{}' is not a value; write a number, as 230.4, 230.4±0.5 or voltage=230.4", text));
  known.value = *value;
  known.tolerance = tolerance ? *tolerance : exactness(number);
  if (std::abs(known.value) <= known.tolerance)
    return tl::make_unexpected(
        fmt::format("'{}' may be 0, which is found everywhere; give a value other than 0", text));
  return known;
}

}  // namespace coupler::scan
