// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace coupler::cli {

/// What a program's exit status means: a contract for scripts.
enum Exit : int {
  ok = 0,
  bad_input = 1,  ///< the map is wrong
  bad_call = 2,   ///< the command line is wrong
  failed = 3,     ///< the network or the device failed
};

}  // namespace coupler::cli
