// SPDX-License-Identifier: Apache-2.0
#include "common/map/loader/rules.hpp"

#include <unordered_map>

#include <fmt/format.h>

#include "common/map/loader/address.hpp"

namespace coupler::loader {
namespace {

/// The same text for the same line, as far as the file tells.
std::string line_key(const Line& line) {
  if (!line.name.empty()) return std::string(line.name);
  constexpr std::string_view folder = "/dev/";
  const bool device_file = line.chip.substr(0, folder.size()) == folder;
  return fmt::format("{} {}", device_file ? line.chip.substr(folder.size()) : line.chip, line.offset);
}

void check_size(const DraftPoint& draft, std::string_view key, std::uint16_t limit, Context& context) {
  const std::uint16_t size = codec::registers(draft.point.format);
  if (size > limit)
    context.problems.error(
        draft.name_at,
        fmt::format("{} has {} registers, more than '{}' of 'limits' ({}) takes in one request",
                    shown(draft.point.name), size, key, limit),
        fmt::format("make it shorter, or raise '{}' if the device takes more", key));
}

}  // namespace

void check_lines(const DraftPoints& points, Context& context) {
  std::unordered_map<std::string, const DraftPoint*> first;
  for (const DraftPoint& draft : points) {
    if (!draft.point.line.present()) continue;
    const auto [found, is_new] = first.emplace(line_key(draft.point.line), &draft);
    if (!is_new)
      context.problems.error(
          draft.line_at,
          fmt::format("the GPIO line of {} is already that of {} (line {})", shown(draft.point.name),
                      shown(found->second->point.name), found->second->line_at.line),
          "give each point a line of its own");
  }
}

void check_sizes(const DraftPoints& points, const Limits& limits, Context& context) {
  for (const DraftPoint& draft : points) {
    if (!draft.placed || holds_bits(draft.point.table)) continue;
    const bool too_long_to_read = codec::registers(draft.point.format) > limits.read_registers;
    if (too_long_to_read || !is_writable(draft.point))
      check_size(draft, "read_registers", limits.read_registers, context);
    else
      check_size(draft, "write_registers", limits.write_registers, context);
  }
}

void warn_of_modicon_numbers(const DraftPoints& points, Context& context) {
  const DraftPoint* first = nullptr;
  std::size_t alike = 0;
  std::size_t others = 0;
  for (const DraftPoint& draft : points) {
    if (!draft.placed || draft.point.table == Table::coils) continue;
    const bool similar = looks_like_modicon(draft.point.address, draft.point.table);
    ++(similar ? alike : others);
    if (similar && first == nullptr) first = &draft;
  }
  if (alike <= others) return;
  const unsigned number = first->point.address;
  context.problems.warning(
      first->address_at,
      fmt::format(
          "{} is read as address {} on the wire, not as number {} of {} in Modicon's count (address {})",
          number, number, number % 10000, to_string(first->point.table), number % 10000 - 1),
      "write 'addressing: zero_based' at the top if that is meant, otherwise 'addressing: modicon'");
}

}  // namespace coupler::loader
