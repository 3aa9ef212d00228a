// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/loader/reader.hpp"
#include "common/map/map.hpp"

namespace coupler::loader {

/// What the top of the file says about the coupler, not about its points.
Connection read_connection(const Reader& top, Context& context);
Polling read_polling(const Reader& top);
Limits read_limits(const Reader& top, Context& context);

}  // namespace coupler::loader
