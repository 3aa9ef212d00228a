// SPDX-License-Identifier: Apache-2.0
// Any value of any type, for code that is not in a hurry: the command line, initial values, tests.
#pragma once

#include <cstdint>
#include <string>
#include <variant>

#include <tl/expected.hpp>

#include "coupler/codec/format.hpp"

namespace coupler::codec {

/// BOOL is bool; BYTE … LWORD, USINT … ULINT and CHAR are uint64_t; SINT … LINT are int64_t.
using Value = std::variant<bool, std::int64_t, std::uint64_t, float, double, std::string>;

/// The value in codec::registers(format) registers. A coil or discrete input is given as one register, 0
/// or 1.
Value decode(const std::uint16_t* registers, const Format& format);

/// Writes the value's bits into its registers and leaves other bits of a shared register alone.
/// Integers convert to every number type that can hold them, floats never to integers. Otherwise the error
/// says what is wrong, as in "300 does not fit into USINT (0 to 255)"; the registers are then unchanged.
tl::expected<void, std::string> encode(const Value& value, const Format& format, std::uint16_t* registers);

/// Returns a text for people: "true", "-5", "3.14" (the shortest text that reads back the same), the text
/// itself.
std::string to_string(const Value& value);

/// A finite number with the fewest digits that tell it from its neighbours of the same type, always with a
/// point, and with an exponent from 1e16 and below 1e-5: "0.25", "-3.0", "1.5e-7". The same text on every
/// machine; a literal of C++ and a number of JSON.
std::string decimal(double value);
std::string decimal(float value);

}  // namespace coupler::codec
