// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/diagnostic.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>

#include "coupler/map/printable.hpp"

namespace coupler {
namespace {

constexpr std::size_t most_before = 80;  // bytes
constexpr std::size_t most_after = 60;
constexpr std::string_view cut = "...";

std::uint8_t byte(std::string_view text, std::size_t i) { return static_cast<std::uint8_t>(text[i]); }
bool continues(std::uint8_t byte) { return (byte & 0xC0U) == 0x80U; }

/// Columns of a terminal: none for what combines with its neighbour, two for the wide scripts and pictures.
std::size_t width(char32_t code) {
  struct Span {
    char32_t first, last;
  };
  constexpr std::array<Span, 4> none{{{0x300, 0x36F}, {0x200B, 0x200F}, {0xFE00, 0xFE0F}, {0xFEFF, 0xFEFF}}};
  constexpr std::array<Span, 7> two{{{0x1100, 0x115F},
                                     {0x2E80, 0xA4CF},
                                     {0xAC00, 0xD7A3},
                                     {0xF900, 0xFAFF},
                                     {0xFF00, 0xFF60},
                                     {0x1F300, 0x1FAFF},
                                     {0x20000, 0x3FFFD}}};
  const auto holds = [code](const Span& span) { return code >= span.first && code <= span.last; };
  if (std::any_of(none.begin(), none.end(), holds)) return 0;
  return std::any_of(two.begin(), two.end(), holds) ? 2 : 1;
}

/// Each byte is replaced by one byte, so that columns stay right.
std::string showable(std::string_view line) {
  std::string text;
  for (std::size_t i = 0; i < line.size();) {
    const Character c = character_at(line, i);
    if (!c.valid || (is_control(c.code) && c.code != '\t') || turns_direction(c.code))
      text.append(c.size, c.valid ? ' ' : '?');
    else
      text += line.substr(i, c.size);
    i += c.size;
  }
  return text;
}

bool in_word(std::string_view text, std::size_t at) {
  const std::uint8_t c = byte(text, at);
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '/' ||
         c >= 0x80;
}

/// `line` is the whole line, `column` counts its bytes from 1.
SourceSnippet snippet(std::string_view line, int column) {
  const std::size_t at = std::min(static_cast<std::size_t>(std::max(column, 1) - 1), line.size());
  std::size_t begin = at > most_before ? at - most_before : 0;
  std::size_t end = std::min(line.size(), at + most_after);
  while (begin < at && begin > 0 && continues(byte(line, begin))) ++begin;
  while (end < line.size() && continues(byte(line, end))) ++end;
  SourceSnippet shown{showable(line.substr(begin, end - begin)), at - begin};
  if (end < line.size()) shown.text += cut;
  if (begin == 0) return shown;
  shown.text.insert(0, cut);
  shown.caret += cut.size();
  return shown;
}

/// Returns the line below the text: blanks as wide as what is before the caret, "^", and "~" to the end of
/// the word.
std::string underline(const SourceSnippet& snippet) {
  const std::string_view text = snippet.text;
  std::string below;
  for (std::size_t i = 0; i < snippet.caret;) {
    const Character c = character_at(text, i);
    below.append(c.code == '\t' ? 1 : width(c.code), c.code == '\t' ? '\t' : ' ');
    i += c.size;
  }
  below += '^';
  if (snippet.caret >= text.size()) return below;
  std::size_t columns = 0;
  for (std::size_t i = snippet.caret; i < text.size() && in_word(text, i);) {
    const Character c = character_at(text, i);
    columns += width(c.code);
    i += c.size;
  }
  if (columns > 1) below.append(columns - 1, '~');
  return below;
}

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

/// Returns what is wrong, and what to do unless `what` says that already.
std::string message(const Diagnostic& d) {
  return printable_lines(d.remedy.empty() ? d.what : fmt::format("{}; {}", d.what, d.remedy));
}

}  // namespace

std::string to_string(const Diagnostic& d) {
  const std::string where = d.line > 0 ? fmt::format("{}:{}:{}", d.file, d.line, d.column) : d.file;
  const char* severity = d.severity == Diagnostic::Severity::error ? "error" : "warning";
  return fmt::format("{}: {}: {}", printable_lines(where), severity, message(d));
}

void quote(Diagnostics& diagnostics, std::string_view text) {
  std::vector<std::string_view> lines;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line = text.substr(begin, end - begin);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    lines.push_back(line);
    begin = end + 1;
  }
  const auto at = [&lines](int line, int column) {
    if (line < 1 || static_cast<std::size_t>(line) > lines.size()) return SourceSnippet{};
    return snippet(lines[static_cast<std::size_t>(line) - 1], column);
  };
  for (Diagnostic& diagnostic : diagnostics) {
    diagnostic.source = at(diagnostic.line, diagnostic.column);
    for (Diagnostic::Note& note : diagnostic.notes) note.source = at(note.line, note.column);
  }
}

bool has_errors(const Diagnostics& diagnostics) {
  return std::any_of(diagnostics.begin(), diagnostics.end(),
                     [](const Diagnostic& d) { return d.severity == Diagnostic::Severity::error; });
}

Diagnostics shortened(Diagnostics diagnostics) {
  if (diagnostics.size() <= most_reported) return diagnostics;
  const auto is_error = [](const Diagnostic& d) { return d.severity == Diagnostic::Severity::error; };
  const auto errors =
      static_cast<std::size_t>(std::count_if(diagnostics.begin(), diagnostics.end(), is_error));
  const std::size_t all = diagnostics.size();
  std::size_t errors_left = std::min(errors, most_reported);
  std::size_t warnings_left = most_reported - errors_left;
  Diagnostics kept;
  for (Diagnostic& diagnostic : diagnostics) {
    std::size_t& left = is_error(diagnostic) ? errors_left : warnings_left;
    if (left == 0) continue;
    --left;
    kept.push_back(std::move(diagnostic));
  }
  const std::size_t hidden_errors = errors - std::min(errors, most_reported);
  kept.push_back({hidden_errors > 0 ? Diagnostic::Severity::error : Diagnostic::Severity::warning,
                  kept.front().file, 0, 0,
                  fmt::format("{} more errors and {} more warnings are not shown", hidden_errors,
                              all - most_reported - hidden_errors),
                  "mend those above first"});
  return kept;
}

std::string render(const Diagnostic& d, Colour colour) {
  const Style& style = colour == Colour::yes ? ansi : plain;
  const bool error = d.severity == Diagnostic::Severity::error;
  const std::string file = printable(d.file);
  std::string text = fmt::format(
      "{}{}:{} {}{}:{} {}\n", style.bold, d.line > 0 ? fmt::format("{}:{}:{}", file, d.line, d.column) : file,
      style.end, error ? style.red : style.magenta, error ? "error" : "warning", style.end, message(d));
  text += source_lines(d.line, d.source, style);
  for (const Diagnostic::Note& note : d.notes) {
    text += fmt::format("{}{}:{}:{}:{} {}note:{} {}\n", style.bold, file, note.line, note.column, style.end,
                        style.cyan, style.end, printable_lines(note.what));
    text += source_lines(note.line, note.source, style);
  }
  return text;
}

Colour colour_of(int descriptor) {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string_view(value == nullptr ? "" : value);
  };
  const bool wanted = variable("NO_COLOR").empty() && variable("TERM") != "dumb" && !variable("TERM").empty();
  return wanted && ::isatty(descriptor) == 1 ? Colour::yes : Colour::no;
}

void print(const Diagnostics& diagnostics) {
  const Colour colour = colour_of(STDERR_FILENO);
  for (const Diagnostic& diagnostic : shortened(diagnostics))
    std::fputs(render(diagnostic, colour).c_str(), stderr);
}

}  // namespace coupler
