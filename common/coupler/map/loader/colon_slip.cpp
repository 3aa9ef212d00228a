// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/colon_slip.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "coupler/map/loader/problems.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/loader/source_text.hpp"

namespace coupler::loader {
namespace {

constexpr std::string_view blanks = " \t\r\n";

bool goes_on(char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '/'; }

/// One past the name that the text begins with: quoted, or of letters and digits. 0 if there is none.
std::size_t name_end(std::string_view text) {
  if (text.empty()) return 0;
  if (const std::size_t quoted = quoted_end(text, 0); quoted != 0)
    return quoted == std::string_view::npos ? 0 : quoted;
  if (!is_letter(text[0])) return 0;
  return static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), goes_on) - text.begin());
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// To the bracket that closes the first one, if both are there.
std::string_view to_closing_bracket(std::string_view value) {
  std::size_t depth = 0;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (value[i] == '{' || value[i] == '[') ++depth;
    if ((value[i] == '}' || value[i] == ']') && --depth == 0) return value.substr(0, i + 1);
  }
  return value;
}

}  // namespace

std::string ColonSlip::remedy() const {
  return "write " + shown(fmt::format("{}:{}{}", name, value.empty() ? "" : " ", value));
}

std::optional<ColonSlip> colon_slip(std::string_view text) {
  const std::string_view name = text.substr(0, name_end(text));
  const std::string_view rest = text.substr(name.size());
  const std::string_view value = trimmed(rest);
  if (name.empty() || value.empty()) return std::nullopt;
  if (rest[0] == ':') {
    if (rest.size() == 1 || blanks.find(rest[1]) != std::string_view::npos) return std::nullopt;
    return ColonSlip{
        fmt::format("a blank is missing behind the ':' of '{}'", name), name,
        rest[1] == '{' || rest[1] == '[' ? to_closing_bracket(value.substr(1)) : value.substr(1)};
  }
  const std::string what = fmt::format("':' is missing after {}", shown(name));
  if (value[0] == '{' || value[0] == '[') return ColonSlip{what, name, to_closing_bracket(value)};
  if (value[0] == '=') return ColonSlip{what, name, trimmed(value.substr(1))};
  const bool is_word_behind = blanks.find(rest[0]) != std::string_view::npos && value[0] != ':';
  if (!is_word_behind || value.find(": ") != std::string_view::npos || value.back() == ':')
    return std::nullopt;  // the blank belongs to a key
  const bool is_one_word = value.find_first_of(" \t\n") == std::string_view::npos;
  return ColonSlip{what, name, is_one_word ? value : std::string_view()};
}

}  // namespace coupler::loader
