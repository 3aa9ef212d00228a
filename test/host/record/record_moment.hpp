// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "coupler/record/lines.hpp"

namespace coupler::host::test {

/// 1.5 s since the beginning, at 2026-11-21T13:20:11.123Z.
inline record::Moment some_moment() {
  return {std::chrono::milliseconds(1500), std::chrono::milliseconds(1795267211123)};
}

}  // namespace coupler::host::test
