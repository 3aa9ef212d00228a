// SPDX-License-Identifier: Apache-2.0
// Requests for a point by its name.
#pragma once

#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "coupler/host/core/write.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// Returns the point of that name. The error says that there is none, and which one may be meant.
tl::expected<const Point*, std::string> point_named(const Map& map, std::string_view name);

/// The same of a point that is read; the error may also say why it never is.
tl::expected<const Point*, std::string> read_point_named(const Map& map, std::string_view name);

/// Makes a write of the value in the text (see parse_value()) to the point of that name. The error says why
/// that is impossible.
tl::expected<Write, std::string> write_named(const Map& map, std::string_view name, std::string_view text);

}  // namespace coupler::host
