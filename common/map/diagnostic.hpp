// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace coupler {

/// One thing that is wrong with a map, where, and what to do about it.
struct Diagnostic {
  enum class Severity { error, warning };
  Severity severity = Severity::error;
  std::string file;
  int line = 0;    ///< from 1; 0: the file as a whole
  int column = 0;  ///< from 1, in bytes
  std::string what;
  std::string remedy;
};

using Diagnostics = std::vector<Diagnostic>;

/// "file:line:col: error: what; remedy", as compilers and editors know it.
std::string to_string(const Diagnostic& diagnostic);

bool has_errors(const Diagnostics& diagnostics);

}  // namespace coupler
