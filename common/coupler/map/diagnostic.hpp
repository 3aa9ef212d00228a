// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "coupler/map/source_snippet.hpp"

namespace coupler {

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

/// Gives the diagnostics and their notes the lines of `text`, the file that they are about.
void quote(Diagnostics& diagnostics, std::string_view text);

enum class Colour { no, yes };

/// For people: to_string(), the source line and a caret below its place, then the notes in the same way. Ends
/// with a newline. Colours are those of ANSI terminals.
std::string render(const Diagnostic& diagnostic, Colour colour);

}  // namespace coupler
