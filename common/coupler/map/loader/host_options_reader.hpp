// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/map/loader/draft_point.hpp"
#include "coupler/map/loader/reader.hpp"

namespace coupler::loader {

/// `defaults:` of the map, as far as it does not depend on a point.
struct HostDefaults {
  HostOptions options;
  const Entry* deadman = nullptr;  ///< its value is of each point's type
};
HostDefaults read_host_defaults(const Reader& top);

/// How the host treats the point: its own keys, and the defaults that apply to it. Its access, and if it is
/// placed its format, count and scale must be known.
void read_host_options(const Reader& reader, const HostDefaults& defaults, DraftPoint& draft,
                       Context& context);

}  // namespace coupler::loader
