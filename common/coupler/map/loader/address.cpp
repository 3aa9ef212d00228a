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

std::optional<Table> owner_of(char prefix) {
  for (const Table table : tables)
    if (prefix_of(table) == prefix) return table;
  return std::nullopt;
}

tl::unexpected<AddressError> wrong(std::string what, std::string remedy) {
  return tl::make_unexpected(AddressError{std::move(what), std::move(remedy)});
}

bool is_number(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), is_digit);
}

bool is_hexadecimal(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789abcdefABCDEF") == std::string_view::npos;
}

/// "100h", "16#64", "$64".
std::string_view foreign_hexadecimal(std::string_view text) {
  const bool ends_in_h =
      !text.empty() && is_digit(text.front()) && (text.back() == 'h' || text.back() == 'H');
  const std::size_t prefix = text.substr(0, 3) == "16#" ? 3 : text.substr(0, 1) == "$" ? 1 : 0;
  const std::string_view digits = ends_in_h ? text.substr(0, text.size() - 1) : text.substr(prefix);
  return (ends_in_h || prefix > 0) && is_hexadecimal(digits) ? digits : std::string_view{};
}

/// Returns what to write for a notation that manuals of devices and PLCs have in place of a number; empty if
/// it is not known.
std::string remedy_for_notation(std::string_view text) {
  if (const std::string_view digits = foreign_hexadecimal(text); !digits.empty())
    return fmt::format("write it as 0x{}", digits);
  if (text.substr(0, 1) == "%")
    return "this is a name in the PLC's program; write the Modbus address that the PLC's manual gives for it";
  const std::size_t end = std::min(text.find_first_not_of("0123456789"), text.size());
  const std::string_view first = text.substr(0, end);
  const char separator = end < text.size() ? text[end] : ' ';
  const std::string_view second = end < text.size() ? text.substr(end + 1) : std::string_view{};
  if (first.empty() && is_letter(separator) && text.find_first_of("0123456789") != std::string_view::npos)
    return fmt::format(
        "write the zero-based address alone; the device's manual says whether {} counts from 0 or 1",
        shown(text));
  if (!first.empty() && separator == ',' && second.empty())
    return fmt::format("write {}: entries in lines of their own need no ','", first);
  if (first.empty() || !is_number(second)) return {};
  switch (separator) {
    case 'x':
    case 'X':
      return first.size() > 1
                 ? ""
                 : fmt::format("write 'addressing: modicon' at the top, and {}{}", first, second);
    case ':':
      if (first.size() == 1 && second.size() > 2)
        return fmt::format("write 'addressing: modicon' at the top, and {}{}", first, second);
      [[fallthrough]];
    case '.':
    case '/':
      return fmt::format("write 'address: {}'; a bit of a register is 'type: BOOL, bit: {}'", first, second);
    case '-':
      return fmt::format("write the first address, {}; 'type' and 'count' say how many follow", first);
    case ',':
    case ' ': return fmt::format("write it without the separator, {}{}", first, second);
    default: return {};
  }
}

tl::expected<std::uint16_t, AddressError> parse_zero_based(std::string_view text) {
  const auto number = parse_unsigned(text);
  if (number && *number < addresses) return static_cast<std::uint16_t>(*number);
  std::string remedy = remedy_for_notation(text);
  if (number)
    remedy = "write the zero-based address, or 'addressing: modicon' at the top if it is a Modicon address";
  return wrong(fmt::format("the address must be a number from 0 to 65535, not {}", shown(text)),
               remedy.empty() ? "write the zero-based address" : std::move(remedy));
}

/// The number begins with the prefix of another table, or of none.
tl::unexpected<AddressError> of_another_table(std::string_view text, Table table) {
  const auto owner = owner_of(text[0]);
  const std::string_view digits = text.substr(1);
  const auto number = parse_unsigned(digits);
  const char prefix = prefix_of(table);
  std::string remedy = fmt::format("write it in six digits, '{}' and the number from 00001 to 65536", prefix);
  if (owner && *number >= 1 && *number <= addresses)
    remedy = fmt::format("move the point to {}, or write {}{}", to_string(*owner), prefix, digits);
  return wrong(fmt::format("{} is not a Modicon address of {}: '{}' stands for {}", text, to_string(table),
                           text[0], owner ? to_string(*owner) : "no table"),
               std::move(remedy));
}

tl::expected<std::uint16_t, AddressError> parse_modicon(std::string_view text, Table table) {
  if (!is_number(text) || text.size() > 6)
    return wrong(fmt::format("a Modicon address has up to six digits, not {}", shown(text)),
                 fmt::format("write it as in '1' or '{}0001'", prefix_of(table)));
  const bool prefixed = text.size() >= 5;
  if (prefixed && text[0] != prefix_of(table)) return of_another_table(text, table);
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
