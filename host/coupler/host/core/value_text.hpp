// SPDX-License-Identifier: Apache-2.0
// Values of a point as people write and read them: true, 4711, 0x2F, -1.5, some text, [1, 2, 3].
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "coupler/map/point.hpp"

namespace coupler::host {

/// Fills range(point).count() registers (bit tables: as many elements, 0 or 1); of a shared register the
/// point's bits, the others zero. The error says what is wrong and what would be right; the registers are
/// then undefined.
tl::expected<void, std::string> parse_value(std::string_view text, const Point& point,
                                            std::uint16_t* registers);

/// Returns in words why the registers of a point are not to be used: is_invalid(), or is_fault().
std::string unusable_text(const std::uint16_t* registers, const Point& point);

/// The value in those host_registers(point) registers, as parse_value() takes it.
std::string format_value(const std::uint16_t* registers, const Point& point);

}  // namespace coupler::host
