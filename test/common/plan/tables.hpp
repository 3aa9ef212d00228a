// SPDX-License-Identifier: Apache-2.0
// Short names for rows of test data.
#pragma once

#include "coupler/map/table.hpp"

namespace coupler::plan {

inline constexpr Table hr = Table::holding_registers;
inline constexpr Table ir = Table::input_registers;
inline constexpr Table co = Table::coils;

}  // namespace coupler::plan
