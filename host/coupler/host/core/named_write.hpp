// SPDX-License-Identifier: Apache-2.0
// What people ask of a point by its name.
#pragma once

#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "coupler/host/core/write.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// The point of that name. The error says that there is none, and which was meant.
tl::expected<const Point*, std::string> point_named(const Map& map, std::string_view name);

/// A write of the value that the text says, as parse_value() takes it, to the point of that name. The error
/// says why there can be none.
tl::expected<Write, std::string> write_named(const Map& map, std::string_view name, std::string_view text);

}  // namespace coupler::host
