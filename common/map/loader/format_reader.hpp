// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/codec/format.hpp"
#include "common/map/loader/reader.hpp"

namespace coupler::loader {

/// The type of a register point and the keys that go with it. `order` is the map's; the point's own overrides
/// it.
void read_format(const Reader& reader, const Entry& point, codec::Order order, codec::Format& format,
                 Context& context);

}  // namespace coupler::loader
