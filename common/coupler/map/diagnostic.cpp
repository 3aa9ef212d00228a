// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/diagnostic.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/map/printable.hpp"

namespace coupler {

std::string to_string(const Diagnostic& d) {
  const std::string where = d.line > 0 ? fmt::format("{}:{}:{}", d.file, d.line, d.column) : d.file;
  const char* severity = d.severity == Diagnostic::Severity::error ? "error" : "warning";
  return printable_lines(fmt::format("{}: {}: {}; {}", where, severity, d.what, d.remedy));
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

}  // namespace coupler
