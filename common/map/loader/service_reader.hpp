// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/loader/reader.hpp"
#include "common/map/service.hpp"

namespace coupler::loader {

/// What the top of the file says about a node that serves the map.
Service read_service(const Reader& top, Context& context);

}  // namespace coupler::loader
