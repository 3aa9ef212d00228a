// SPDX-License-Identifier: Apache-2.0
// What elements of a preset file consist of. nullptr, nullopt: there is no such thing.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "common/map/loader/entry.hpp"

namespace coupler::loader {

const Entry* child(const Entry& entry, std::string_view key);

/// An address or the value of a register.
std::optional<std::uint16_t> word(const Entry& entry);
std::optional<std::uint16_t> word(const Entry& entry, std::string_view key);

}  // namespace coupler::loader
