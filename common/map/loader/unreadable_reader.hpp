// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/map/loader/address.hpp"
#include "common/map/loader/draft_point.hpp"
#include "common/map/loader/reader.hpp"
#include "common/map/map.hpp"

namespace coupler::loader {

/// `unreadable:`, a list of areas; sorted by table and address. No readable point may be in one.
std::vector<Unreadable> read_unreadable(const Reader& top, const DraftPoints& points, Addressing addressing,
                                        Context& context);

}  // namespace coupler::loader
