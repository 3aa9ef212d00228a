// SPDX-License-Identifier: Apache-2.0
#include "coupler/codec/type.hpp"

namespace coupler::codec {
namespace {

bool same_letters(std::string_view a, std::string_view upper) {
  if (a.size() != upper.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const char c = a[i] >= 'a' && a[i] <= 'z' ? static_cast<char>(a[i] - 'a' + 'A') : a[i];
    if (c != upper[i]) return false;
  }
  return true;
}

}  // namespace

std::optional<Type> parse_type(std::string_view name) {
  for (const auto& type : enumeration_of<Type>.words)
    if (same_letters(name, type.word)) return type.value;
  return std::nullopt;
}

}  // namespace coupler::codec
