// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/formats/importer.hpp"

namespace coupler::formats {

/// A table of points: one row a point, one column a key of the map's points, `table` and `name` among them,
/// in any order. With a column `unit`, one map a unit. docs/import-export.md describes the columns.
std::vector<ForeignUnit> read_csv(std::string_view text, loader::Problems& problems);

}  // namespace coupler::formats
