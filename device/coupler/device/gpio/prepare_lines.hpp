// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/device/gpio/line_requests.hpp"

namespace coupler::device {

/// The GPIO lines of the map, found and requested by the libgpiod that is built in (backend.hpp): as few
/// requests as it allows, each of up to max_group_size lines. Lines that `before` (may be null) holds with
/// the same settings stay in their requests, which cannot give up single lines: what the map does not want
/// any more of such a request stays held, outputs in their safe state.
tl::expected<std::unique_ptr<NextWiring>, std::string> prepare_lines(const Map& map, LineRequests* before,
                                                                     bool safe, Log& log);

}  // namespace coupler::device
