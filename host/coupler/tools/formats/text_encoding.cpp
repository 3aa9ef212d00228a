// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/text_encoding.hpp"

#include <array>
#include <cstdint>

#include "coupler/map/printable.hpp"

namespace coupler::formats {
namespace {

constexpr char32_t replacement = 0xFFFD;

void append(std::string& text, char32_t code) {
  const auto byte = [&](char32_t value) { text += static_cast<char>(static_cast<unsigned char>(value)); };
  if (code < 0x80) return byte(code);
  if (code < 0x800) {
    byte(0xC0 | code >> 6);
  } else {
    if (code < 0x10000) {
      byte(0xE0 | code >> 12);
    } else {
      byte(0xF0 | code >> 18);
      byte(0x80 | (code >> 12 & 0x3F));
    }
    byte(0x80 | (code >> 6 & 0x3F));
  }
  byte(0x80 | (code & 0x3F));
}

bool is_valid_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const Character c = character_at(text, at);
    if (!c.valid) return false;
    at += c.size;
  }
  return true;
}

/// `bytes` behind the byte order mark. Half a pair of surrogates, and half a unit at the end, become U+FFFD.
std::string from_utf16(std::string_view bytes, bool big_endian) {
  const auto unit = [&](std::size_t at) {
    const auto first = static_cast<unsigned char>(bytes[at]);
    const auto second = static_cast<unsigned char>(bytes[at + 1]);
    return static_cast<char32_t>(big_endian ? first << 8 | second : second << 8 | first);
  };
  std::string text;
  for (std::size_t at = 0; at + 1 < bytes.size(); at += 2) {
    char32_t code = unit(at);
    if (code >= 0xD800 && code < 0xDC00 && at + 3 < bytes.size()) {
      const char32_t low = unit(at + 2);
      if (low >= 0xDC00 && low < 0xE000) {
        code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
        at += 2;
      }
    }
    append(text, code >= 0xD800 && code < 0xE000 ? replacement : code);
  }
  if (bytes.size() % 2 != 0) append(text, replacement);
  return text;
}

/// The Unicode Consortium's CP1252.TXT; 0: not assigned, which is Latin-1's control then.
constexpr std::array<char16_t, 32> of_80_to_9f{
    0x20AC, 0,      0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
    0x2039, 0x0152, 0,      0x017D, 0,      0,      0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
    0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0,      0x017E, 0x0178};

std::string from_windows_1252(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    const char16_t known = byte >= 0x80 && byte < 0xA0 ? of_80_to_9f[byte - 0x80U] : char16_t{0};
    append(text, known != 0 ? known : byte);
  }
  return text;
}

}  // namespace

Utf8 to_utf8(std::string_view bytes) {
  const std::string_view mark = bytes.substr(0, 2);
  if (mark == "\xFF\xFE" || mark == "\xFE\xFF")
    return {from_utf16(bytes.substr(2), mark[0] == '\xFE'), WrittenIn::utf16};
  if (!is_valid_utf8(bytes)) return {from_windows_1252(bytes), WrittenIn::windows_1252};
  return {std::string(bytes), WrittenIn::utf8};
}

}  // namespace coupler::formats
