// SPDX-License-Identifier: Apache-2.0
// `unreadable:` and `reserve:`, lists of areas.
#pragma once

#include <vector>

#include "coupler/map/loader/address.hpp"
#include "coupler/map/loader/draft_point.hpp"
#include "coupler/map/loader/reader.hpp"
#include "coupler/map/map.hpp"

namespace coupler::loader {

struct Area {
  Table table;
  modbus::Range range;
  Position at;
};
using Areas = std::vector<Area>;

/// The areas below `key`, in the order of the file.
Areas read_areas(const Reader& top, std::string_view key, Addressing addressing, Context& context);

/// No point is read from an unreadable area.
void check_unreadable(const Areas& areas, const DraftPoints& points, Context& context);

/// No point stands in a reserved area.
void check_reserved(const Areas& areas, const DraftPoints& points, Context& context);

/// As the model has them, sorted by table and address.
std::vector<Unreadable> sorted_unreadable(const Areas& areas);

}  // namespace coupler::loader
