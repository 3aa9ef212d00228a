// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "coupler/tools/formats/structured_text.hpp"

namespace coupler::formats::structured_text {

using codec::Type;

namespace {

/// A value is m * 2 ** (e - base); m is a whole number, below 2 * hidden.
constexpr std::string_view functions =
    R"(FUNCTION {to} : {real}
VAR_INPUT
  bits : {bits};
END_VAR
VAR
  e : INT;
  m : {real};
END_VAR
  e := {bits}_TO_INT(SHR(bits, {fraction}) AND {bits}#16#{mask:X});
  m := {whole}_TO_{real}({bits}_TO_{whole}(bits AND {bits}#16#{rest:X}));
  IF e > 0 THEN
    m := m + {real}#{hidden}.0;
  ELSE
    e := 1;
  END_IF;
  WHILE e > {base} DO
    m := m * {real}#2.0;
    e := e - 1;
  END_WHILE;
  WHILE (e < {base}) AND (m > {real}#0.0) DO
    m := m / {real}#2.0;
    e := e + 1;
  END_WHILE;
  IF (bits AND {bits}#16#{sign:X}) <> {bits}#16#0 THEN
    m := -m;
  END_IF;
  {to} := m;
END_FUNCTION

FUNCTION {from} : {bits}
VAR_INPUT
  value : {real};
END_VAR
VAR
  e : INT;
  m : {real};
  sign : {bits};
END_VAR
  m := value;
  IF m < {real}#0.0 THEN
    m := -m;
    sign := {bits}#16#{sign:X};
  ELSE
    sign := {bits}#16#0;
  END_IF;
  IF m = {real}#0.0 THEN
    e := 1;
  ELSE
    e := {base};
  END_IF;
  WHILE (m < {real}#{hidden}.0) AND (e > 1) DO
    m := m * {real}#2.0;
    e := e - 1;
  END_WHILE;
  WHILE m >= {real}#{twice}.0 DO
    m := m / {real}#2.0;
    e := e + 1;
  END_WHILE;
  {from} := sign OR {whole}_TO_{bits}(INT_TO_{whole}(e - 1) * {hidden} + {real}_TO_{whole}(m));
END_FUNCTION
)";

}  // namespace

std::string float_functions(Type type, const FloatFunctions& names) {
  const bool is_real = type == Type::REAL;
  const unsigned fraction_bits = is_real ? 23 : 52;
  const unsigned base = is_real ? 150 : 1075;
  const unsigned exponent_mask = is_real ? 0xFF : 0x7FF;
  const std::uint64_t hidden = std::uint64_t{1} << fraction_bits;
  const std::uint64_t sign = std::uint64_t{1} << (is_real ? 31U : 63U);
  return fmt::format(functions, fmt::arg("to", is_real ? names.to_real : names.to_lreal),
                     fmt::arg("from", is_real ? names.from_real : names.from_lreal),
                     fmt::arg("real", to_string(type)), fmt::arg("bits", bits_of(type)),
                     fmt::arg("whole", is_real ? "UDINT" : "ULINT"), fmt::arg("fraction", fraction_bits),
                     fmt::arg("base", base), fmt::arg("mask", exponent_mask), fmt::arg("rest", hidden - 1),
                     fmt::arg("hidden", hidden), fmt::arg("twice", 2 * hidden), fmt::arg("sign", sign));
}

}  // namespace coupler::formats::structured_text
