// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "coupler/map/allowed_values.hpp"
#include "coupler/tools/formats/structured_text.hpp"

namespace coupler::formats::structured_text {
namespace {

using codec::Type;

/// Lines, indented as they are nested.
class Body {
 public:
  void add(std::string_view line) { text_ += fmt::format("{:{}}{}\n", "", 2 * depth_, line); }
  void open(std::string_view line) {
    add(line);
    ++depth_;
  }
  void outdent() { --depth_; }
  void middle(std::string_view line) {
    outdent();
    open(line);
  }
  void close(std::string_view line) {
    --depth_;
    add(line);
  }
  std::string text() && { return std::move(text_); }

 private:
  std::string text_;
  int depth_ = 1;
};

std::string converted(std::string_view from, std::string_view to, std::string_view value) {
  return from == to ? std::string(value) : fmt::format("{}_TO_{}({})", from, to, value);
}

/// "4 + i", "i"
std::string sum(std::uint32_t offset, std::string_view step) {
  return offset == 0 ? std::string(step) : fmt::format("{} + {}", offset, step);
}

/// The expressions for one point, an element `i` of it if it is an array.
class Expressions {
 public:
  explicit Expressions(const Access& access)
      : access_(access), format_(access.point.format), is_array_(access.point.count > 1) {}

  std::string variable() const { return access_.variable + (is_array_ ? "[i]" : ""); }

  // Returns the byte of a coil or a discrete input.
  std::string byte() const {
    return fmt::format("{}[{}]", access_.block,
                       is_array_ ? bit_index() + " / 8" : fmt::to_string(access_.offset / 8));
  }
  std::string byte_mask() const {
    return is_array_ ? fmt::format("SHL(BYTE#16#01, {} MOD 8)", bit_index())
                     : fmt::format("BYTE#16#{:02X}", 1U << (access_.offset % 8));
  }

  /// The `k`-th register of the value.
  std::string word(unsigned k) const {
    const std::uint32_t first = access_.offset + k;
    if (!is_array_) return fmt::format("{}[{}]", access_.block, first);
    const unsigned width = codec::registers(format_);
    const std::string step = width == 1 ? "i" : fmt::format("{} * i", width);
    return fmt::format("{}[{}]", access_.block, sum(first, step));
  }
  std::string swapped(std::string word) const {
    return codec::bytes_swapped(format_.order) ? fmt::format("ROL({}, 8)", word) : std::move(word);
  }
  /// Returns the register that holds the `k`-th 16 bits, the most significant first.
  std::string ordered_word(unsigned k) const {
    return word(codec::words_reversed(format_.order) ? codec::registers(format_) - 1 - k : k);
  }

  /// All registers of the value as one bit string.
  std::string bits() const {
    const unsigned count = codec::registers(format_);
    if (count == 1) return swapped(word(0));
    std::string all;
    for (unsigned k = 0; k < count; ++k) {
      const std::string wide = converted("WORD", bits_of(format_.type), swapped(ordered_word(k)));
      const unsigned shift = 16 * (count - 1 - k);
      all += (k == 0 ? "" : " OR ") + (shift == 0 ? wide : fmt::format("SHL({}, {})", wide, shift));
    }
    return all;
  }

  /// The published value of bits, or of a raw value if it is a float.
  std::string published(const std::string& bits) const {
    std::string raw = raw_value(bits);
    const codec::Scale& scale = access_.point.scale;
    if (!scale.present()) return raw;
    const std::string number = converted(to_string(format_.type), "LREAL", raw);
    return scaled(number, scale);
  }
  /// The bits of the published value; of a scaled one, those of `raw`.
  std::string raw_bits() const {
    const codec::Scale& scale = access_.point.scale;
    std::string raw = variable();
    if (scale.present()) raw = converted("LREAL", to_string(format_.type), "raw");
    const FloatFunctions& functions = access_.functions;
    if (format_.type == Type::REAL) return fmt::format("{}({})", functions.from_real, raw);
    if (format_.type == Type::LREAL) return fmt::format("{}({})", functions.from_lreal, raw);
    return is_declared_as_bits(format_.type) ? raw
                                             : converted(to_string(format_.type), bits_of(format_.type), raw);
  }

 private:
  std::string bit_index() const {
    return access_.offset == 0 ? "i" : fmt::format("({} + i)", access_.offset);
  }

  std::string raw_value(const std::string& bits) const {
    const FloatFunctions& functions = access_.functions;
    if (format_.type == Type::REAL) return fmt::format("{}({})", functions.to_real, bits);
    if (format_.type == Type::LREAL) return fmt::format("{}({})", functions.to_lreal, bits);
    return is_declared_as_bits(format_.type)
               ? bits
               : converted(bits_of(format_.type), to_string(format_.type), bits);
  }

  const Access& access_;
  const codec::Format& format_;
  bool is_array_;
};

std::string_view bits_variable(Type type) { return type == Type::REAL ? "bits_32" : "bits_64"; }

std::string half_of(const std::string& word, bool high) {
  return high ? fmt::format("WORD_TO_BYTE(SHR({}, 8))", word)
              : fmt::format("WORD_TO_BYTE({} AND WORD#16#00FF)", word);
}

std::string with_half(const std::string& word, bool high, const std::string& byte) {
  return high ? fmt::format("{0} := ({0} AND WORD#16#00FF) OR SHL(BYTE_TO_WORD({1}), 8);", word, byte)
              : fmt::format("{0} := ({0} AND WORD#16#FF00) OR BYTE_TO_WORD({1});", word, byte);
}

/// The number in some bits of the register, as bits of its type.
std::string field_of(const codec::Format& format, const Expressions& at) {
  const std::string bits = fmt::format("SHR({}, {}) AND WORD#16#{:04X}", at.swapped(at.word(0)), format.bit,
                                       codec::largest_in(format.bits));
  return codec::width(format.type) == 8 ? fmt::format("WORD_TO_BYTE({})", bits) : fmt::format("({})", bits);
}

std::string with_field(const codec::Format& format, const Expressions& at) {
  const bool is_byte = codec::width(format.type) == 8;
  const std::string number = is_byte ? fmt::format("BYTE_TO_WORD({})", at.raw_bits()) : at.raw_bits();
  return fmt::format("{0} := ({0} AND WORD#16#{1:04X}) OR {2};", at.word(0), 0xFFFF ^ codec::mask(format),
                     at.swapped(fmt::format("SHL({}, {})", number, format.bit)));
}

/// The bit of a byte or of a register.
struct BitPlace {
  std::string cell;
  std::string mask;
  std::string_view zero;
};

BitPlace bit_place(const Point& point, const Expressions& at) {
  if (holds_bits(point.table)) return {at.byte(), at.byte_mask(), "BYTE#16#00"};
  return {at.word(0), fmt::format("WORD#16#{:04X}", codec::mask(point.format)), "WORD#16#0000"};
}

bool is_high_half(const codec::Format& format) { return codec::mask(format) == 0xFF00; }

void decode_element(const Point& point, const Expressions& at, Body& body) {
  const Type type = point.format.type;
  if (type == Type::BOOL) {
    const BitPlace bit = bit_place(point, at);
    body.add(fmt::format("{} := ({} AND {}) <> {};", at.variable(), bit.cell, bit.mask, bit.zero));
  } else if (point.format.bits != 0) {
    body.add(fmt::format("{} := {};", at.variable(), at.published(field_of(point.format, at))));
  } else if (codec::width(type) == 8) {
    body.add(fmt::format("{} := {};", at.variable(),
                         at.published(half_of(at.word(0), is_high_half(point.format)))));
  } else if (is_float(type)) {
    const std::string bits(bits_variable(type));
    const std::string exponent = type == Type::REAL ? "DWORD#16#7F800000" : "LWORD#16#7FF0000000000000";
    body.add(fmt::format("{} := {};", bits, at.bits()));
    body.open(fmt::format("IF ({} AND {}) = {} THEN", bits, exponent, exponent));
    body.add("not_finite := TRUE;");
    body.middle("ELSE");
    body.add(fmt::format("{} := {};", at.variable(), at.published(bits)));
    body.close("END_IF;");
  } else {
    body.add(fmt::format("{} := {};", at.variable(), at.published(at.bits())));
  }
}

void encode_number(const Point& point, const Expressions& at, Body& body) {
  const Type type = point.format.type;
  const unsigned count = codec::registers(point.format);
  if (point.format.bits != 0) {
    body.add(with_field(point.format, at));
  } else if (codec::width(type) == 8) {
    body.add(with_half(at.word(0), is_high_half(point.format), at.raw_bits()));
  } else if (count == 1) {
    body.add(fmt::format("{} := {};", at.word(0), at.swapped(at.raw_bits())));
  } else {
    const std::string_view bits = count == 2 ? "bits_32" : "bits_64";
    body.add(fmt::format("{} := {};", bits, at.raw_bits()));
    for (unsigned k = 0; k < count; ++k) {
      const unsigned shift = 16 * (count - 1 - k);
      const std::string part = shift == 0 ? std::string(bits) : fmt::format("SHR({}, {})", bits, shift);
      body.add(
          fmt::format("{} := {};", at.ordered_word(k), at.swapped(converted(bits_of(type), "WORD", part))));
    }
  }
}

void encode_element(const Point& point, const Expressions& at, Body& body) {
  if (point.format.type == Type::BOOL) {
    const BitPlace bit = bit_place(point, at);
    body.open(fmt::format("IF {} THEN", at.variable()));
    body.add(fmt::format("{0} := {0} OR {1};", bit.cell, bit.mask));
    body.middle("ELSE");
    body.add(fmt::format("{0} := {0} AND NOT {1};", bit.cell, bit.mask));
    body.close("END_IF;");
    return;
  }
  const bool is_limited =
      limits_values(point) || point.scale.present() || is_float(point.format.type) || point.format.bits != 0;
  if (!is_limited) return encode_number(point, at, body);
  std::string_view end = "END_IF;";
  if (!point.values.empty()) {
    std::string labels;
    for (const NamedValue& named : point.values)  // all are allowed: the loader sees to that
      labels += fmt::format("{}{}", labels.empty() ? "" : ", ", named.value);
    body.open(fmt::format("CASE {} OF", at.variable()));
    body.open(labels + ":");
    encode_number(point, at, body);
    body.outdent();
    end = "END_CASE;";
  } else {
    if (point.scale.present()) body.add(fmt::format("raw := {};", unscaled(at.variable(), point.scale)));
    body.open(fmt::format("IF {} THEN", allowed(point, at.variable())));
    encode_number(point, at, body);
  }
  body.middle("ELSE");
  body.add("refused := TRUE;");
  body.close(end);
}

void decode_text(const Access& access, Body& body) {
  const bool first_is_high = !codec::bytes_swapped(access.point.format.order);
  const std::string word = fmt::format("{}[{}]", access.block, sum(access.offset, "i / 2"));
  body.open("IF i MOD 2 = 0 THEN");
  body.add(fmt::format("{}[i] := {};", access.variable, half_of(word, first_is_high)));
  body.middle("ELSE");
  body.add(fmt::format("{}[i] := {};", access.variable, half_of(word, !first_is_high)));
  body.close("END_IF;");
}

void encode_text(const Access& access, Body& body) {
  const bool first_is_high = !codec::bytes_swapped(access.point.format.order);
  const std::string word = fmt::format("{}[{}]", access.block, sum(access.offset, "i / 2"));
  body.open("IF i MOD 2 = 0 THEN");
  body.add(with_half(word, first_is_high, access.variable + "[i]"));
  body.middle("ELSE");
  body.add(with_half(word, !first_is_high, access.variable + "[i]"));
  body.close("END_IF;");
}

template <class Text, class Element>
std::string statements(const Access& access, Text text, Element element) {
  Body body;
  const Point& point = access.point;
  const bool is_text = point.format.type == Type::STRING;
  const unsigned count = is_text ? point.format.length : point.count;
  const bool loops = is_text || count > 1;
  if (loops) body.open(fmt::format("FOR i := 0 TO {} DO", count - 1));
  if (is_text)
    text(access, body);
  else
    element(point, Expressions(access), body);
  if (loops) body.close("END_FOR;");
  return std::move(body).text();
}

}  // namespace

std::string decoding(const Access& access) { return statements(access, decode_text, decode_element); }
std::string encoding(const Access& access) { return statements(access, encode_text, encode_element); }

std::string copying(const ReadOnlyBits& bits) {
  if (bits.read == nullptr) return {};
  const auto word = [&](std::string_view image, const Block& block) {
    return fmt::format("{}.{}[{}]", image, block.name, bits.address - block.range.start());
  };
  return fmt::format("  {0} := ({0} AND NOT WORD#16#{1:04X}) OR ({2} AND WORD#16#{1:04X});\n",
                     word("image", *bits.written), bits.mask, word("read_image", *bits.read));
}

}  // namespace coupler::formats::structured_text
