// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace coupler {

/// A line of a file, safe to show: valid UTF-8, no control characters but tabs, none that turn the direction
/// of writing. Of a long line only what is around the caret.
struct SourceSnippet {
  std::string text;
  std::size_t caret = 0;  ///< the byte of `text` that is meant; its size: the end of the line
};

/// One thing that is wrong with a map, where, and what to do about it.
struct Diagnostic {
  enum class Severity { error, warning };
  /// Another place of the same file that has to do with it.
  struct Note {
    int line = 0;    ///< from 1
    int column = 0;  ///< from 1, in bytes
    std::string what;
    SourceSnippet source{};
  };

  Severity severity = Severity::error;
  std::string file;
  int line = 0;    ///< from 1; 0: the file as a whole
  int column = 0;  ///< from 1, in bytes
  std::string what;
  std::string remedy;
  std::vector<Note> notes{};
  SourceSnippet source{};
};

using Diagnostics = std::vector<Diagnostic>;

/// "file:line:col: error: what; remedy", as compilers and editors know it.
std::string to_string(const Diagnostic& diagnostic);

bool has_errors(const Diagnostics& diagnostics);

/// Nobody reads more, and the first ones often cause the others.
constexpr std::size_t most_reported = 100;

/// At most so many of them, errors first, in their order; the last one says how many there are more.
Diagnostics shortened(Diagnostics diagnostics);

/// Copies the lines that they are about from `text`, the file, into the diagnostics and their notes.
void quote(Diagnostics& diagnostics, std::string_view text);

enum class Colour { no, yes };

/// Returns a text for people: to_string(), the source line and a caret below its place, then the notes in the
/// same way. It ends with a newline. Colours are those of ANSI terminals.
std::string render(const Diagnostic& diagnostic, Colour colour);

/// Yes for a terminal, unless NO_COLOR (no-color.org) is set.
Colour colour_of(int descriptor);

/// Renders them, shortened, to standard error.
void print(const Diagnostics& diagnostics);

}  // namespace coupler
