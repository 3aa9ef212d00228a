// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "coupler/device/gpio/line_requests.hpp"

namespace coupler::device {

/// A request of the wiring before that goes on.
struct KeptRequest {
  std::size_t group = 0;                ///< of the outputs, or of the inputs
  std::vector<const LineSpec*> wanted;  ///< for each of its lines; null: the map does not want it
};

/// What becomes of held lines when other ones are wanted: the difference of two wirings. Views the wanted
/// lines.
struct RequestPlan {
  std::vector<KeptRequest> outputs;
  std::vector<KeptRequest> inputs;
  std::vector<LineSpec> fresh;  ///< nobody holds them: they can be requested while the others are in use
  std::vector<LineSpec> later;  ///< held in requests that end: they can be requested after that
  std::string errors;  ///< outputs whose settings cannot change, since lines beside them stay; one a line
};

/// `before` may be null.
RequestPlan plan_requests(const LineRequests* before, const std::vector<LineSpec>& wanted);

}  // namespace coupler::device
