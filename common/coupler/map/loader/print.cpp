// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/print.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace coupler {

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
  for (const Diagnostic& diagnostic : diagnostics) std::fputs(render(diagnostic, colour).c_str(), stderr);
}

}  // namespace coupler
