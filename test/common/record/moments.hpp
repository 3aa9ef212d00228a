// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "coupler/record/lines.hpp"

namespace coupler::record {

/// So long since the beginning, at 2026-11-21T13:20:11.123Z.
inline Moment at_second(double seconds) {
  return {std::chrono::duration_cast<Nanoseconds>(std::chrono::duration<double>(seconds)),
          std::chrono::milliseconds(1795267211123)};
}

inline Head example_head() {
  return {"press",
          "192.168.1.20:502",
          "0123456789abcdef",
          "name: press\nmapping: {coils: {lamp: 0}}\n",
          {{"lamp", 0.5}},
          {{"reset", "write-only"}}};
}

}  // namespace coupler::record
