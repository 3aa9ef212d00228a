// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/scan/texts.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "coupler/codec/text.hpp"

namespace coupler::scan {
namespace {

using codec::Order;
using modbus::Range;

constexpr std::size_t fewest_characters = 6;
constexpr std::size_t fewest_different = 3;

enum class Kind { upper, lower, digit, other };

constexpr bool is_printable(unsigned byte) { return byte >= 0x20 && byte < 0x7F; }

constexpr Kind kind_of(char c) {
  if (c >= 'A' && c <= 'Z') return Kind::upper;
  if (c >= 'a' && c <= 'z') return Kind::lower;
  return c >= '0' && c <= '9' ? Kind::digit : Kind::other;
}

/// Behind a text there may also be a number, in a register whose other byte is 0.
constexpr bool may_end_a_text(unsigned word) {
  return is_printable(word) && kind_of(static_cast<char>(word)) != Kind::other;
}

/// Counts how often the kind of character changes from one to the next. From a capital letter to the small
/// ones behind it is no change.
std::size_t roughness(std::string_view text) {
  std::size_t changes = 0;
  for (std::size_t i = 1; i < text.size(); ++i) {
    const Kind from = kind_of(text[i - 1]);
    const Kind to = kind_of(text[i]);
    changes += from != to && !(from == Kind::upper && to == Kind::lower) ? 1U : 0U;
  }
  return changes;
}

bool is_like_a_text(std::string_view text) {
  const auto others =
      std::count_if(text.begin(), text.end(), [](char c) { return kind_of(c) == Kind::other && c != ' '; });
  return text.size() >= fewest_characters && static_cast<std::size_t>(others) * 4 <= text.size() &&
         std::set<char>(text.begin(), text.end()).size() >= fewest_different;
}

/// Registers of printable characters.
struct Run {
  std::uint32_t start;
  std::uint32_t count;  ///< of registers; 0: there are none
  std::size_t characters;
  std::optional<Order> order;  ///< if its end shows it: the last register has one character, and a NUL
};

Run run_at(const TableFindings& table, std::uint32_t start, std::uint32_t end) {
  end = std::min<std::uint32_t>(end, start + codec::longest_text / 2);
  std::uint32_t at = start;
  for (; at < end; ++at)
    if (!is_printable(table.value(at) >> 8U) || !is_printable(table.value(at) & 0xFFU)) break;
  const std::size_t characters = std::size_t{at - start} * 2;
  const unsigned last = at < end ? table.value(at) : 0;
  if (may_end_a_text(last >> 8U) && (last & 0xFFU) == 0)
    return {start, at + 1 - start, characters + 1, Order::ABCD};
  if (may_end_a_text(last)) return {start, at + 1 - start, characters + 1, Order::BADC};
  return {start, at - start, characters, std::nullopt};
}

codec::Format format_of(const Run& run, Order order) {
  codec::Format format;
  format.type = codec::Type::STRING;
  format.order = order;
  format.length = static_cast<std::uint16_t>(run.characters);
  format.encoding = codec::Encoding::ascii;
  return format;
}

std::string read(const TableFindings& table, const Run& run, Order order) {
  std::vector<std::uint16_t> registers;
  registers.reserve(run.count);
  for (std::uint32_t at = run.start; at < run.start + run.count; ++at) registers.push_back(table.value(at));
  std::string text;
  codec::decode_text(registers.data(), format_of(run, order), text);
  return text;
}

/// nullopt: it is no text.
std::optional<FoundText> text_of(const TableFindings& table, const Run& run) {
  const std::string high_first = read(table, run, Order::ABCD);
  const std::string low_first = read(table, run, Order::BADC);
  const bool is_low_smoother = roughness(low_first) < roughness(high_first);
  const Order order = run.order.value_or(is_low_smoother ? Order::BADC : Order::ABCD);
  const std::string& text = order == Order::ABCD ? high_first : low_first;
  const std::string& other = order == Order::ABCD ? low_first : high_first;
  if (!is_like_a_text(text)) return std::nullopt;
  const bool is_certain = run.order || roughness(low_first) != roughness(high_first);
  return FoundText{table.table(), Range::of(run.start, run.count), format_of(run, order), text,
                   is_certain ? "" : other};
}

}  // namespace

std::vector<FoundText> find_texts(const std::vector<TableFindings>& tables) {
  std::vector<FoundText> found;
  for (const TableFindings& table : tables) {
    if (holds_bits(table.table())) continue;
    for (const Range range : table.readable()) {
      for (std::uint32_t at = range.start(); at < range.end();) {
        const Run run = run_at(table, at, range.end());
        if (auto text = run.count > 0 ? text_of(table, run) : std::nullopt) found.push_back(*std::move(text));
        at += std::max<std::uint32_t>(run.count, 1);
      }
    }
  }
  return found;
}

std::string point_text(const FoundText& text) {
  return fmt::format("{{address: {}, type: STRING, length: {}, order: {}}}", text.range.start(),
                     text.format.length, codec::order_text(text.format));
}

std::string value_text(const FoundText& text) {
  if (text.other.empty()) return fmt::format("\"{}\"", text.text);
  return fmt::format("\"{}\", or \"{}\" with order: {}", text.text, text.other,
                     codec::bytes_swapped(text.format.order) ? "AB" : "BA");
}

}  // namespace coupler::scan
