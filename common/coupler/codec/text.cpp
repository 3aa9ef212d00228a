// SPDX-License-Identifier: Apache-2.0
#include "coupler/codec/text.hpp"

#include <array>

namespace coupler::codec {
namespace {

std::uint8_t wire_byte(const std::uint16_t* registers, const Format& format, std::size_t i) {
  const bool first_is_low = bytes_swapped(format.order);
  const bool low = (i % 2 == 0) == first_is_low;
  return static_cast<std::uint8_t>(low ? registers[i / 2] & 0xFF : registers[i / 2] >> 8);
}

void set_wire_byte(std::uint16_t* registers, const Format& format, std::size_t i, std::uint8_t byte) {
  const bool first_is_low = bytes_swapped(format.order);
  const bool low = (i % 2 == 0) == first_is_low;
  std::uint16_t& word = registers[i / 2];
  word = static_cast<std::uint16_t>(low ? (word & 0xFF00) | byte : (word & 0x00FF) | (byte << 8));
}

/// The code point at the front of `text`, which is shortened by it; -1 if `text` does not begin with valid
/// UTF-8 (RFC 3629: no overlong forms, no surrogates, at most U+10FFFF).
std::int32_t take_code_point(std::string_view& text) {
  const auto lead = static_cast<std::uint8_t>(text.front());
  text.remove_prefix(1);
  if (lead < 0x80) return lead;
  const unsigned more = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : 1;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < more) return -1;
  auto code = static_cast<std::int32_t>(lead & (0x3F >> more));
  for (unsigned i = 0; i < more; ++i) {
    const auto byte = static_cast<std::uint8_t>(text.front());
    if ((byte & 0xC0) != 0x80) return -1;
    text.remove_prefix(1);
    code = (code << 6) | (byte & 0x3F);
  }
  constexpr std::int32_t smallest[] = {0, 0x80, 0x800, 0x10000};
  if (code < smallest[more] || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) return -1;
  return code;
}

/// Calls put(byte) for each byte of `text` in the encoding; false where a character has none.
template <class Put>
bool for_each_encoded(std::string_view text, Encoding encoding, Put&& put) {
  while (!text.empty()) {
    const std::string_view before = text;
    const std::int32_t code = take_code_point(text);
    if (code < 0) return false;
    if (encoding == Encoding::utf8) {
      for (const char c : before.substr(0, before.size() - text.size())) put(static_cast<std::uint8_t>(c));
    } else {
      if (code > (encoding == Encoding::ascii ? 0x7F : 0xFF)) return false;
      put(static_cast<std::uint8_t>(code));
    }
  }
  return true;
}

/// The byte as UTF-8; returns the end of what it wrote.
char* put_decoded(std::uint8_t byte, Encoding encoding, char* text) {
  if (byte < 0x80 || encoding == Encoding::utf8) {
    *text++ = static_cast<char>(byte);
  } else if (encoding == Encoding::ascii) {
    *text++ = '?';
  } else {
    *text++ = static_cast<char>(0xC0 | (byte >> 6));
    *text++ = static_cast<char>(0x80 | (byte & 0x3F));
  }
  return text;
}

bool is_utf8(std::string_view text) {
  while (!text.empty())
    if (take_code_point(text) < 0) return false;
  return true;
}

/// The text with "\\xff" in place of each byte that begins no character.
std::string escaped(std::string_view text) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string result;
  while (!text.empty()) {
    const std::string_view before = text;
    const auto first = static_cast<std::uint8_t>(text.front());
    if (take_code_point(text) >= 0) {
      result += before.substr(0, before.size() - text.size());
      continue;
    }
    result.append({'\\', 'x', digits[first >> 4U], digits[first & 0xFU]});
    text = before.substr(1);
  }
  return result;
}

}  // namespace

std::size_t decode_text(const std::uint16_t* registers, const Format& format, char* text) {
  char* end = text;
  for (std::size_t i = 0; i < format.length; ++i) {
    const std::uint8_t byte = wire_byte(registers, format, i);
    if (byte == 0) break;
    end = put_decoded(byte, format.encoding, end);
  }
  return static_cast<std::size_t>(end - text);
}

void decode_text(const std::uint16_t* registers, const Format& format, std::string& text) {
  text.resize(max_text_size(format));
  text.resize(decode_text(registers, format, text.data()));
  if (!is_utf8(text)) text = escaped(text);
}

std::optional<std::uint8_t> first_unknown_byte(const std::uint16_t* registers, const Format& format) {
  if (format.encoding == Encoding::latin1) return std::nullopt;
  std::array<char, longest_text> bytes{};
  std::size_t size = 0;
  while (size < format.length && (bytes[size] = static_cast<char>(wire_byte(registers, format, size))) != 0)
    ++size;
  for (std::string_view rest(bytes.data(), size); !rest.empty();) {
    const auto first = static_cast<std::uint8_t>(rest.front());
    const std::int32_t code = take_code_point(rest);
    if (code < 0 || (format.encoding == Encoding::ascii && code > 0x7F)) return first;
  }
  return std::nullopt;
}

bool is_plain_text(std::string_view text) {
  while (!text.empty()) {
    const std::int32_t code = take_code_point(text);
    if (code < 0x20 || (code >= 0x7F && code < 0xA0)) return false;
  }
  return true;
}

TextError encode_text(std::string_view text, const Format& format, std::uint16_t* registers) {
  if (text.find('\0') != std::string_view::npos) return TextError::has_nul;
  std::size_t size = 0;
  if (!for_each_encoded(text, format.encoding, [&](std::uint8_t) { ++size; }))
    return TextError::not_encodable;
  if (size > format.length) return TextError::too_long;
  for (std::size_t i = 0; i < codec::registers(format); ++i) registers[i] = 0;
  std::size_t at = 0;
  for_each_encoded(text, format.encoding,
                   [&](std::uint8_t byte) { set_wire_byte(registers, format, at++, byte); });
  return TextError::none;
}

}  // namespace coupler::codec
