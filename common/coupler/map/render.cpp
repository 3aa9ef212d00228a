// SPDX-License-Identifier: Apache-2.0
// Diagnostics as compilers show them to people.
#include <fmt/format.h>

#include "coupler/map/diagnostic.hpp"
#include "coupler/map/printable.hpp"

namespace coupler {
namespace {

struct Style {
  std::string_view bold, red, magenta, cyan, green, end;
};
constexpr Style plain{};
constexpr Style ansi{"\033[1m", "\033[1;31m", "\033[1;35m", "\033[1;36m", "\033[1;32m", "\033[0m"};

std::string source_lines(int line, const SourceSnippet& source, const Style& style) {
  if (source.text.empty()) return {};
  return fmt::format("{:>5} | {}\n      | {}{}{}\n", line, source.text, style.green, underline(source),
                     style.end);
}

}  // namespace

std::string render(const Diagnostic& d, Colour colour) {
  const Style& style = colour == Colour::yes ? ansi : plain;
  const bool error = d.severity == Diagnostic::Severity::error;
  const std::string file = printable(d.file);
  std::string text = fmt::format("{}{}:{} {}{}:{} {}; {}\n", style.bold,
                                 d.line > 0 ? fmt::format("{}:{}:{}", file, d.line, d.column) : file,
                                 style.end, error ? style.red : style.magenta, error ? "error" : "warning",
                                 style.end, printable_lines(d.what), printable_lines(d.remedy));
  text += source_lines(d.line, d.source, style);
  for (const Diagnostic::Note& note : d.notes) {
    text += fmt::format("{}{}:{}:{}:{} {}note:{} {}\n", style.bold, file, note.line, note.column, style.end,
                        style.cyan, style.end, printable_lines(note.what));
    text += source_lines(note.line, note.source, style);
  }
  return text;
}

}  // namespace coupler
