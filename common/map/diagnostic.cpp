// SPDX-License-Identifier: Apache-2.0
#include "common/map/diagnostic.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace coupler {

std::string to_string(const Diagnostic& d) {
  const std::string where = d.line > 0 ? fmt::format("{}:{}:{}", d.file, d.line, d.column) : d.file;
  const char* severity = d.severity == Diagnostic::Severity::error ? "error" : "warning";
  return fmt::format("{}: {}: {}; {}", where, severity, d.what, d.remedy);
}

bool has_errors(const Diagnostics& diagnostics) {
  return std::any_of(diagnostics.begin(), diagnostics.end(),
                     [](const Diagnostic& d) { return d.severity == Diagnostic::Severity::error; });
}

}  // namespace coupler
