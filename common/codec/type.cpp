// SPDX-License-Identifier: Apache-2.0
#include "common/codec/type.hpp"

#include <array>
#include <utility>

namespace coupler::codec {
namespace {

constexpr std::array<std::pair<Type, std::string_view>, 17> names{{
    {Type::BOOL, "BOOL"},
    {Type::BYTE, "BYTE"},
    {Type::WORD, "WORD"},
    {Type::DWORD, "DWORD"},
    {Type::LWORD, "LWORD"},
    {Type::SINT, "SINT"},
    {Type::INT, "INT"},
    {Type::DINT, "DINT"},
    {Type::LINT, "LINT"},
    {Type::USINT, "USINT"},
    {Type::UINT, "UINT"},
    {Type::UDINT, "UDINT"},
    {Type::ULINT, "ULINT"},
    {Type::REAL, "REAL"},
    {Type::LREAL, "LREAL"},
    {Type::CHAR, "CHAR"},
    {Type::STRING, "STRING"},
}};

bool same_letters(std::string_view a, std::string_view upper) {
  if (a.size() != upper.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const char c = a[i] >= 'a' && a[i] <= 'z' ? static_cast<char>(a[i] - 'a' + 'A') : a[i];
    if (c != upper[i]) return false;
  }
  return true;
}

}  // namespace

std::string_view to_string(Type type) {
  for (const auto& [value, name] : names)
    if (value == type) return name;
  return "?";
}

std::optional<Type> parse_type(std::string_view name) {
  for (const auto& [value, upper] : names)
    if (same_letters(name, upper)) return value;
  return std::nullopt;
}

}  // namespace coupler::codec
