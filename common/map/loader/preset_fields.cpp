// SPDX-License-Identifier: Apache-2.0
#include "common/map/loader/preset_fields.hpp"

#include <algorithm>

#include "common/map/loader/scalar.hpp"

namespace coupler::loader {

const Entry* child(const Entry& entry, std::string_view key) {
  const auto found = std::find_if(entry.children.begin(), entry.children.end(),
                                  [&](const Entry& e) { return e.key == key; });
  return found == entry.children.end() ? nullptr : &*found;
}

std::optional<std::uint16_t> word(const Entry& entry) {
  const auto value = parse_unsigned(entry.text);
  if (!value || *value > 0xFFFF) return std::nullopt;
  return static_cast<std::uint16_t>(*value);
}

std::optional<std::uint16_t> word(const Entry& entry, std::string_view key) {
  const Entry* found = child(entry, key);
  return found != nullptr ? word(*found) : std::nullopt;
}

}  // namespace coupler::loader
