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

/// A value of the type is declared as a bit string: a CHAR as a BYTE.
bool is_declared_as_bits(codec::Type type);

/// The bit string of a type's width.
std::string_view bits_of(codec::Type type);

/// A number as the point publishes it, from its registers. Whole numbers have no point, others always do.
std::string number(const Point& point, const std::uint16_t* registers);

/// A literal of LREAL.
std::string lreal(double value);

/// "raw * 0.1 - 40.0", and the other way round: "(value + 40.0) / 0.1".
std::string scaled(const std::string& raw, const codec::Scale& scale);
std::string unscaled(const std::string& value, const codec::Scale& scale);

/// Returns the initial value of the variable, ":= [1, 2]" without the ":=". It is empty if all of it is zero.
std::string initial_value(const Point& point);

// Allowed values: structured_text_allowed.cpp

/// The condition under which `variable`, one value, may be written. Of a scaled point it is about `raw`, an
/// LREAL that is not rounded yet.
std::string allowed(const Point& point, const std::string& variable);

/// An output without `initial` can begin with 0.
bool may_be_zero(const Point& point);

/// The registers with which an output begins: `initial`, else 0, else the allowed value nearest to 0.
std::vector<std::uint16_t> start_registers(const Point& point);

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

/// Returns the blocks that are read, as coupler/plan reads the map.
std::vector<Block> read_blocks(const Map& map);
/// Points that follow one another are written together; parts of one register always are.
std::vector<Block> write_blocks(const Map& map);

/// Returns the initial value of a part of the write image, from start_registers(). It is empty if all of it
/// is zero.
std::string initial_image(const Block& block, const Map& map);

/// Bits in a register that is written, of a point that is only read. A device takes whole registers.
struct ReadOnlyBits {
  std::uint32_t point;  ///< index into Map::points
  std::uint16_t mask;
  std::uint16_t address;
  const Block* written;
  const Block* read;  ///< nullptr: no request reads the register
};
std::vector<ReadOnlyBits> read_only_bits(const Map& map, const std::vector<Block>& reads,
                                         const std::vector<Block>& writes);

// Statements: structured_text_code.cpp

/// The functions that convert between REAL or LREAL and their bits.
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

/// From the image into the variable. What both use: i, raw, bits_32, bits_64; not_finite and refused become
/// TRUE.
std::string decoding(const Access& access);
/// From the variable into the image; other bits of a shared register stay. A value that must not be written
/// leaves the image as it is.
std::string encoding(const Access& access);
/// From the parameter `read_image` into the image; nothing if no request reads them.
std::string copying(const ReadOnlyBits& bits);

// structured_text_float.cpp

/// Two functions, for 32 bits or for 64.
std::string float_functions(codec::Type type, const FloatFunctions& names);

}  // namespace coupler::formats::structured_text
