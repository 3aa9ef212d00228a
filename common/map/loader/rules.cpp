// SPDX-License-Identifier: Apache-2.0
#include "common/map/loader/rules.hpp"

#include <unordered_map>

#include <fmt/format.h>

#include "common/map/loader/address.hpp"

namespace coupler::loader {
namespace {

/// The same text for the same line or channel, as far as the file tells. Empty: there is none.
std::string hardware(const Point& point) {
  // An ADC and a DAC of one device may number their channels alike.
  if (point.iio.present())
    return fmt::format("iio {} {} {}", to_string(point.table), point.iio.device, point.iio.channel);
  if (point.pwm.present()) return fmt::format("pwm {} {}", point.pwm.chip, point.pwm.channel);
  const Line& line = point.line;
  if (!line.present()) return {};
  if (!line.name.empty()) return std::string(line.name);
  constexpr std::string_view folder = "/dev/";
  const bool device_file = line.chip.substr(0, folder.size()) == folder;
  return fmt::format("{} {}", device_file ? line.chip.substr(folder.size()) : line.chip, line.offset);
}

void check_size(const DraftPoint& draft, std::string_view key, std::uint16_t limit, Context& context) {
  const std::uint32_t size = range(draft.point).count();
  if (size > limit)
    context.problems.error(draft.name_at,
                           fmt::format("{} has {} {}, more than '{}' of 'limits' ({}) takes in one request",
                                       shown(draft.point.name), size,
                                       holds_bits(draft.point.table) ? "bits" : "registers", key, limit),
                           fmt::format("make it shorter, or raise '{}' if the device takes more", key));
}

}  // namespace

void check_lines(const DraftPoints& points, Context& context) {
  std::unordered_map<std::string, const DraftPoint*> first;
  for (const DraftPoint& draft : points) {
    std::string key = hardware(draft.point);
    if (key.empty()) continue;
    const auto [found, is_new] = first.emplace(std::move(key), &draft);
    const std::string_view kind = is_analogue(draft.point) ? "channel" : "line";
    if (!is_new)
      context.problems.error(
          draft.line_at,
          fmt::format("the {}{} of {} is already that of {} (line {})", kind == "line" ? "GPIO " : "", kind,
                      shown(draft.point.name), shown(found->second->point.name), found->second->line_at.line),
          fmt::format("give each point a {} of its own", kind),
          {{found->second->line_at, "the other is here"}});
  }
}

void check_sizes(const DraftPoints& points, const Limits& limits, Context& context) {
  for (const DraftPoint& draft : points) {
    if (!draft.placed) continue;
    const bool bits = holds_bits(draft.point.table);
    const std::uint16_t most_read = bits ? limits.read_bits : limits.read_registers;
    if (range(draft.point).count() > most_read || !is_writable(draft.point))
      check_size(draft, bits ? "read_bits" : "read_registers", most_read, context);
    else
      check_size(draft, bits ? "write_bits" : "write_registers",
                 bits ? limits.write_bits : limits.write_registers, context);
  }
}

void warn_of_modicon_numbers(const DraftPoints& points, Context& context) {
  const DraftPoint* first = nullptr;
  std::size_t alike = 0;
  std::size_t others = 0;
  for (const DraftPoint& draft : points) {
    if (!draft.placed || draft.addressless || draft.point.table == Table::coils) continue;
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
