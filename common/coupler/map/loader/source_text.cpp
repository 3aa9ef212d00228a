// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/source_text.hpp"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

namespace coupler::loader {
namespace {

std::uint8_t byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<std::uint8_t>(text[i]) : std::uint8_t{0};
}

/// Bytes of the UTF-8 character at `i` (RFC 3629, section 4), 0 if it is none.
std::size_t character_size(std::string_view text, std::size_t i) {
  const std::uint8_t first = byte_at(text, i);
  if (first < 0x80) return 1;
  if (first < 0xC2 || first > 0xF4) return 0;
  const std::size_t size = first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  for (std::size_t k = 1; k < size; ++k)
    if ((byte_at(text, i + k) & 0xC0U) != 0x80U) return 0;
  const std::uint8_t second = byte_at(text, i + 1);
  const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool surrogate = first == 0xED && second > 0x9F;
  const bool beyond = first == 0xF4 && second > 0x8F;
  return overlong || surrogate || beyond ? 0 : size;
}

bool is_control(char c) {
  return (static_cast<std::uint8_t>(c) < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == '\x7F';
}

}  // namespace

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  return text.substr(0, mark.size()) == mark ? text.substr(mark.size()) : text;
}

bool check_text(std::string_view text, Problems& problems) {
  if (text.size() > max_text_size) {
    problems.error({}, fmt::format("the file has {} bytes, a map at most {}", text.size(), max_text_size),
                   "give the map's file");
    return false;
  }
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t size = character_size(text, i);
    if (size == 0) {
      problems.error(position_of(text, i), fmt::format("byte 0x{:02X} is not UTF-8", byte_at(text, i)),
                     "save the file as UTF-8");
      return false;
    }
    if (is_control(text[i])) {
      problems.error(position_of(text, i), fmt::format("control character 0x{:02X}", byte_at(text, i)),
                     "remove it");
      return false;
    }
    i += size;
  }
  return true;
}

void indent_with_blanks(std::string& text) {
  constexpr const char* blanks = " \t";
  for (std::size_t tab = text.find('\t'); tab != std::string::npos; tab = text.find('\t', tab)) {
    const std::size_t before = text.find_last_not_of(blanks, tab);
    const std::size_t after = std::min(text.find_first_not_of(blanks, tab), text.size());
    const std::size_t begin = before == std::string::npos ? 0 : before + 1;
    const bool starts_line = begin == 0 || text[begin - 1] == '\n';
    const bool ends_line = after == text.size() || text[after] == '\n' || text[after] == '\r';
    const bool is_comment = begin == tab && after < text.size() && text[after] == '#';
    if (starts_line && (ends_line || is_comment)) std::fill(text.begin() + begin, text.begin() + after, ' ');
    tab = after;
  }
}

Position position_of(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const std::size_t newline = before.rfind('\n');
  const std::size_t line_start = newline == std::string_view::npos ? 0 : newline + 1;
  return {static_cast<int>(1 + std::count(before.begin(), before.end(), '\n')),
          static_cast<int>(1 + before.size() - line_start)};
}

}  // namespace coupler::loader
