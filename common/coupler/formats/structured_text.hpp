// SPDX-License-Identifier: Apache-2.0
// The pieces of Structured Text (IEC 61131-3) that structured_text_export.cpp puts together.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/map/map.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler::formats::structured_text {

// Words: structured_text.cpp

/// A word of the language, of one of its dialects, or of the standard functions, in any case: nothing can
/// have it as its name.
bool is_reserved(std::string_view name);

/// The name with what an identifier can have: letters, digits, single underscores, none at the end.
std::string identifier(std::string_view name);

/// "(* text *)" on one line, whatever is in the text.
std::string comment(std::string_view text);

/// How a value of the point is declared: "ARRAY [0..3] OF LREAL". Scaled ones are LREAL, texts are bytes with
/// a zero behind the last.
std::string declared_type(const Point& point);

/// The bit string of a type's width.
std::string_view bits_of(codec::Type type);

/// A number as the point publishes it, from its registers. Whole numbers have no point, others always do.
std::string number(const Point& point, const std::uint16_t* registers);

/// "raw * 0.1 - 40.0", and the other way round: "(value + 40.0) / 0.1".
std::string scaled(const std::string& raw, const codec::Scale& scale);
std::string unscaled(const std::string& value, const codec::Scale& scale);

/// What the variable is at start, ":= [1, 2]" without the ":=". Empty: nothing but zeros, or no such value.
std::string initial_value(const Point& point);

// Requests: structured_text_blocks.cpp

/// One request: its part of the image is an array.
struct Block {
  Table table;
  modbus::Range range;
  modbus::Function function;
  double rate;                        ///< Hz; 0: not polled
  std::vector<std::uint32_t> points;  ///< indices into Map::points
  std::string name;
};

/// As coupler/plan reads the map.
std::vector<Block> read_blocks(const Map& map);
/// Points that follow one another are written together; parts of one register always are.
std::vector<Block> write_blocks(const Map& map);

// Statements: structured_text_code.cpp

/// What converts between REAL or LREAL and its bits.
struct FloatFunctions {
  std::string to_real, from_real, to_lreal, from_lreal;
};

/// One point in one function block.
struct Access {
  const Point& point;
  std::string variable;  ///< "values.speed"
  std::string block;     ///< the part of the image, an array: "image.coils_0"
  std::uint32_t offset;  ///< of the point's first address in the block
  const FloatFunctions& functions;
};

/// From the image into the variable. What both use: i, bits_32, bits_64; not_finite and refused become TRUE.
std::string decoding(const Access& access);
/// From the variable into the image; other bits of a shared register stay. A value that must not be written
/// leaves the image as it is.
std::string encoding(const Access& access);

// structured_text_float.cpp

/// Two functions, for 32 bits or for 64.
std::string float_functions(codec::Type type, const FloatFunctions& names);

}  // namespace coupler::formats::structured_text
