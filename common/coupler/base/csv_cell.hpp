// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace coupler {

/// A spreadsheet takes the text for a formula and runs it, whatever wrote it; not if a ' stands before it.
inline bool would_be_run(std::string_view text) {
  const std::size_t first = text.find_first_not_of('\'');
  return first != std::string_view::npos &&
         std::string_view("=+-@\t\r").find(text[first]) != std::string_view::npos;
}

/// Returns the text as a cell of a CSV file (RFC 4180). It is quoted where it has a separator of any country,
/// a quote or an end of line, or blanks at an end, which readers drop.
inline std::string csv_cell(std::string_view text) {
  constexpr std::string_view blanks = " \t";
  const bool blank_around = !text.empty() && (blanks.find(text.front()) != std::string_view::npos ||
                                              blanks.find(text.back()) != std::string_view::npos);
  if (!blank_around && text.find_first_of(";,\t\"\r\n") == std::string_view::npos) return std::string(text);
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

}  // namespace coupler
