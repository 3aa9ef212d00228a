// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/address.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include <fmt/format.h>

#include "coupler/map/loader/problems.hpp"
#include "coupler/map/loader/scalar.hpp"

namespace coupler::loader {
namespace {

constexpr std::uint64_t addresses = 65536;
constexpr std::array<char, tables.size()> prefixes{'0', '1', '3', '4'};

char prefix_of(Table table) { return prefixes[index(table)]; }

std::string owner_of(char prefix) {
  for (const Table table : tables)
    if (prefix_of(table) == prefix) return fmt::format("'{}' stands for {}", prefix, to_string(table));
  return fmt::format("'{}' stands for no table", prefix);
}

tl::unexpected<AddressError> wrong(std::string what, std::string remedy) {
  return tl::make_unexpected(AddressError{std::move(what), std::move(remedy)});
}

tl::expected<std::uint16_t, AddressError> parse_zero_based(std::string_view text) {
  const auto number = parse_unsigned(text);
  if (number && *number < addresses) return static_cast<std::uint16_t>(*number);
  return wrong(
      fmt::format("the address must be a number from 0 to 65535, not {}", shown(text)),
      number ? "write the zero-based address, or 'addressing: modicon' at the top if it is a Modicon address"
             : "write the zero-based address");
}

tl::expected<std::uint16_t, AddressError> parse_modicon(std::string_view text, Table table) {
  const bool digits = !text.empty() && std::all_of(text.begin(), text.end(), is_digit);
  if (!digits || text.size() > 6)
    return wrong(fmt::format("a Modicon address has up to six digits, not {}", shown(text)),
                 fmt::format("write it as in '1' or '{}0001'", prefix_of(table)));
  const bool prefixed = text.size() >= 5;
  if (prefixed && text[0] != prefix_of(table))
    return wrong(
        fmt::format("{} is not a Modicon address of {}: {}", text, to_string(table), owner_of(text[0])),
        fmt::format("write it in six digits, '{}' and the number from 00001", prefix_of(table)));
  const auto number = parse_unsigned(text.substr(prefixed ? 1 : 0));
  if (*number >= 1 && *number <= addresses) return static_cast<std::uint16_t>(*number - 1);
  return wrong(fmt::format("a Modicon number must be from 1 to 65536, not {}", *number),
               "write 1 for the first address, or 'addressing: zero_based' at the top");
}

}  // namespace

tl::expected<std::uint16_t, AddressError> parse_address(std::string_view text, Table table,
                                                        Addressing addressing) {
  return addressing == Addressing::zero_based ? parse_zero_based(text) : parse_modicon(text, table);
}

std::string address_text(std::uint16_t address, Table table, Addressing addressing) {
  if (addressing == Addressing::zero_based) return fmt::to_string(address);
  return fmt::format("{}{:05}", prefix_of(table), address + 1);
}

bool looks_like_modicon(std::uint16_t address, Table table) {
  const int prefix = prefix_of(table) - '0';
  return prefix != 0 && address / 10000 == prefix && address % 10000 != 0;
}

}  // namespace coupler::loader
