// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/csv_type.hpp"

#include <algorithm>

#include "coupler/codec/type_name.hpp"
#include "coupler/map/loader/scalar.hpp"

namespace coupler::formats {
namespace {

using codec::Type;

constexpr std::string_view orders_of_two[] = {"ABCD", "CDAB", "BADC", "DCBA"};

std::string_view without_end(std::string_view text, std::string_view ends) {
  const std::size_t last = text.find_last_not_of(ends);
  return text.substr(0, last == std::string_view::npos ? 0 : last + 1);
}

/// Takes "CDAB" from the end of "Float CDAB", "float32_cdab" and "Float (CDAB)".
std::string_view take_order(std::string_view text, TypeCell& cell) {
  constexpr std::size_t letters = 4;
  const std::string_view bare = without_end(text, ")] ");
  if (bare.size() <= letters) return text;
  const std::string last = lower(bare.substr(bare.size() - letters));
  const auto* found = std::find_if(std::begin(orders_of_two), std::end(orders_of_two),
                                   [&](const std::string_view order) { return lower(order) == last; });
  const std::string_view rest = without_end(bare.substr(0, bare.size() - letters), " _-([");
  const auto type = codec::parse_type(rest);
  if (found == std::end(orders_of_two) || !type || codec::width(*type) <= 16)
    return text;  // NOLINT: one register
  cell.order = *found;
  return rest;
}

/// Takes "[8]" or "(8)" from the end, and 6 from that of "string6".
std::string_view take_number_behind(std::string_view text, TypeCell& cell) {
  const bool closed = !text.empty() && (text.back() == ']' || text.back() == ')');
  const std::string_view inside = closed ? text.substr(0, text.size() - 1) : text;
  const std::string_view before = without_end(inside, "0123456789");
  const auto number = loader::parse_unsigned(inside.substr(before.size()));
  if (!number) return text;
  const std::string_view name = without_end(before, closed ? "[( " : " _-");
  const auto type = lower(name) == "ascii" ? Type::STRING : codec::parse_type(name);
  if (type == Type::STRING || (closed && type == Type::CHAR)) {
    cell.type = Type::STRING;
    cell.number = number;
    return to_string(Type::STRING);
  }
  if (!closed || !type) return text;
  cell.is_array = true;
  cell.count = number;
  return name;
}

}  // namespace

TypeCell read_type_cell(std::string_view text) {
  TypeCell cell;
  cell.type = codec::parse_type(text);
  if (!cell.type) {
    text = take_order(text, cell);
    text = take_number_behind(text, cell);
    constexpr std::string_view array = "array";
    const std::string low = lower(text);
    if (low.size() > array.size() && low.compare(low.size() - array.size(), array.size(), array) == 0) {
      const std::string_view one = without_end(text.substr(0, text.size() - array.size()), " _-");
      cell.is_array = codec::parse_type(one) || codec::find_ambiguous_type(one) != nullptr;
      if (cell.is_array) text = one;
    }
    if (!cell.type) cell.type = codec::parse_type(text);
  }
  cell.text = text;
  return cell;
}

}  // namespace coupler::formats
