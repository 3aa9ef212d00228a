// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace coupler::codec {

/// Published value = raw × gain + offset.
struct Scale {
  double gain = 1;  ///< finite, not 0
  double offset = 0;

  constexpr bool present() const { return gain != 1 || offset != 0; }
};

}  // namespace coupler::codec
