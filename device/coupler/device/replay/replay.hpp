// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <tl/expected.hpp>

#include "coupler/device/node/options.hpp"
#include "coupler/map/owned_map.hpp"

namespace coupler::device {

class StderrLog;

struct ReplayError {
  int exit;  ///< status of the program
  std::string text;
};

/// Serves a recording until it ends, or a signal asks to stop. `map`: null is the recording's own. Returns
/// the exit status: serve()'s, or 1 if clients wrote something else than was recorded.
tl::expected<int, ReplayError> serve_replay(const Options& options, const MapPtr& map, StderrLog& log);

}  // namespace coupler::device
