// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/formats/importer.hpp"

namespace coupler::formats {

/// Unslave's config.json (https://unserver.xyz/docs/unslave): values of coils (C), discrete inputs (DI),
/// input registers (IR) and holding registers (HR). It knows no names and no types: the points are skeletons,
/// UINT, called after their place.
std::vector<ForeignUnit> read_unslave(std::string_view text, loader::Problems& problems);

}  // namespace coupler::formats
