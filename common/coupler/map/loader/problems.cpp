// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/problems.hpp"

#include <algorithm>
#include <tuple>

#include "coupler/map/printable.hpp"

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
  if (is_full()) return;
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
  for (std::size_t at = 0; at < text.size();) {
    if (result.size() > longest) return result + "...'";
    const Character c = character_at(text, at);
    if (is_control(c.code) || turns_direction(c.code))
      result += ' ';
    else
      result += text.substr(at, c.size);
    at += c.size;
  }
  return result + "'";
}

}  // namespace coupler::loader
