// SPDX-License-Identifier: Apache-2.0
#include "coupler/plan/explain.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace coupler::plan {
namespace {

using Reason = Cut::Reason;

int digit(Table table) {
  switch (table) {
    case Table::coils: return 0;
    case Table::discrete_inputs: return 1;
    case Table::input_registers: return 3;
    case Table::holding_registers: return 4;
  }
  return 0;
}

std::string addresses(std::uint32_t count) {
  return count == 1 ? "1 address" : fmt::format("{} addresses", count);
}

}  // namespace

std::string modicon(Table table, std::uint32_t address) {
  const std::uint32_t number = address + 1;
  return number < 10000 ? fmt::format("{}{:04}", digit(table), number)
                        : fmt::format("{}{:05}", digit(table), number);
}

std::string_view to_string(Reason reason) {
  switch (reason) {
    case Reason::end_of_table: return "end_of_table";
    case Reason::other_rate: return "other_rate";
    case Reason::unreadable: return "unreadable";
    case Reason::write_only: return "write_only";
    case Reason::unmapped: return "unmapped";
    case Reason::gap: return "gap";
    case Reason::limit: return "limit";
  }
  return "?";
}

std::string_view key_of(Reason reason, Table table) {
  const bool bits = holds_bits(table);
  switch (reason) {
    case Reason::unmapped: return bits ? "discrete_read_continuous" : "registers_read_continuous";
    case Reason::gap: return bits ? "discrete_read_separation_gap" : "registers_read_separation_gap";
    case Reason::limit: return bits ? "limits: read_bits" : "limits: read_registers";
    case Reason::unreadable: return "unreadable";
    case Reason::write_only: return "access";
    case Reason::other_rate: return "rate";
    case Reason::end_of_table: return "";
  }
  return "";
}

std::string explain_end(const ReadSpan& span, const Map& map) {
  const auto& [reason, next, between] = span.end;
  if (!next) return "nothing more to read";
  const std::string_view name = map.points[*next].name;
  const std::string_view key = key_of(reason, span.table);
  switch (reason) {
    case Reason::other_rate:
      return fmt::format("{} is read at {:g} Hz", name, rate_of(map, map.points[*next]));
    case Reason::unreadable: return fmt::format("unreadable addresses lie before {}", name);
    case Reason::write_only: return fmt::format("a point that can only be written lies before {}", name);
    case Reason::unmapped:
      return fmt::format("{} before {} may not be read ({}: false)",
                         between == 1 ? "1 unmapped address" : fmt::format("{} unmapped addresses", between),
                         name, key);
    case Reason::gap:
      return fmt::format("{} before {}, gap {} ({})", addresses(between), name,
                         holds_bits(span.table) ? map.polling.discrete_gap : map.polling.register_gap, key);
    case Reason::limit:
      return fmt::format("with {} more than {} in a request ({})", name,
                         holds_bits(span.table)
                             ? std::min(map.limits.read_bits, modbus::max_read_bits)
                             : std::min(map.limits.read_registers, modbus::max_read_registers),
                         key);
    case Reason::end_of_table: break;
  }
  return {};
}

std::string_view words_of(NotRead reason) {
  switch (reason) {
    case NotRead::write_only: return "write-only";
    case NotRead::unreadable: return "in what the map calls unreadable";
    case NotRead::too_long: return "too long for one reply";
  }
  return {};
}

std::string_view to_string(NotRead reason) {
  switch (reason) {
    case NotRead::write_only: return "write_only";
    case NotRead::unreadable: return "unreadable";
    case NotRead::too_long: return "too_long";
  }
  return "?";
}

}  // namespace coupler::plan
