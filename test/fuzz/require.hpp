// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <cstdlib>

namespace coupler::fuzz {

/// Ends the program, which libFuzzer takes for a crash, if a rule does not hold.
inline void require(bool holds, const char* rule) {
  if (holds) return;
  std::fprintf(stderr, "fuzz: this does not hold: %s\n", rule);
  std::abort();
}

}  // namespace coupler::fuzz
