// SPDX-License-Identifier: Apache-2.0
#include "coupler/generate/macros.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

namespace coupler::generate {
namespace {

constexpr std::string_view macros[] = {"assert", "errno", "linux",  "major", "minor",
                                       "stderr", "stdin", "stdout", "unix"};

// POSIX.1-2017, XSH 2.2.2: members of structures, which the headers of Linux make macros of.
// And the one of <math.h>.
constexpr std::string_view prefixes[] = {"h_",  "math_errhandling", "s6_", "sa_", "sched_",
                                         "si_", "sigev_",           "st_"};

bool is_capital(char c) { return c >= 'A' && c <= 'Z'; }
bool is_small(char c) { return c >= 'a' && c <= 'z'; }

bool has_lone_capital(std::string_view name) {
  for (std::size_t i = 0; i < name.size(); ++i)
    if (is_capital(name[i]) && (i + 1 == name.size() || !is_small(name[i + 1]))) return true;
  return false;
}

}  // namespace

Span<const std::string_view> small_macros() { return macros; }

bool could_be_macro(std::string_view name) {
  return has_lone_capital(name) ||
         std::find(std::begin(macros), std::end(macros), name) != std::end(macros) ||
         std::any_of(std::begin(prefixes), std::end(prefixes),
                     [&](std::string_view prefix) { return name.substr(0, prefix.size()) == prefix; });
}

WithoutMacros without_macros(std::vector<std::string> names) {
  names.erase(std::remove_if(names.begin(), names.end(),
                             [](const std::string& name) { return !could_be_macro(name); }),
              names.end());
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  if (names.empty()) return {};
  WithoutMacros out;
  out.before =
      "\n// Macros of other headers may have these names. They are put aside here, and are back below.\n";
  out.after = "\n";
  for (const std::string& name : names) {
    out.before += fmt::format("#pragma push_macro(\"{0}\")\n#undef {0}\n", name);
    out.after += fmt::format("#pragma pop_macro(\"{}\")\n", name);
  }
  return out;
}

}  // namespace coupler::generate
