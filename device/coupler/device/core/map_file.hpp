// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "coupler/base/span.hpp"
#include "coupler/modbus/file_record.hpp"

namespace coupler::device {

/// A piece of the map's text as FC 20 serves it (coupler/map/identity.hpp says how): fills `bytes`, two for
/// each register asked for. False if the text ends before.
bool read_map_file(std::string_view text, modbus::FileRecord wanted, Span<std::uint8_t> bytes);

}  // namespace coupler::device
