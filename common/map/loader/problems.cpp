// SPDX-License-Identifier: Apache-2.0
#include "common/map/loader/problems.hpp"

#include <algorithm>
#include <tuple>

namespace coupler::loader {

void Problems::error(Position at, std::string what, std::string remedy, const Notes& related) {
  add(Diagnostic::Severity::error, at, std::move(what), std::move(remedy), related);
}

void Problems::warning(Position at, std::string what, std::string remedy, const Notes& related) {
  add(Diagnostic::Severity::warning, at, std::move(what), std::move(remedy), related);
}

void Problems::add(Diagnostic::Severity severity, Position at, std::string what, std::string remedy,
                   const Notes& related) {
  if (severity == Diagnostic::Severity::error) ++errors_;
  found_.push_back({severity, file_, at.line, at.column, std::move(what), std::move(remedy)});
  for (const Note& note : related) found_.back().notes.push_back({note.at.line, note.at.column, note.what});
}

Diagnostics Problems::sorted() && {
  std::stable_sort(found_.begin(), found_.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return std::tie(a.line, a.column) < std::tie(b.line, b.column);
  });
  return std::move(found_);
}

std::string shown(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string result = "'";
  for (const char c : text) {
    const bool continues_character = (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
    if (result.size() > longest && !continues_character) return result + "…'";
    const bool control = static_cast<unsigned char>(c) < 0x20U || c == '\x7F';
    result += control ? ' ' : c;
  }
  return result + "'";
}

}  // namespace coupler::loader
