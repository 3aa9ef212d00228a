// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/preset_watchdog.hpp"

#include <algorithm>

#include "coupler/map/loader/scalar.hpp"

namespace coupler::loader {
namespace {

using Write = PresetWatchdog::Write;

bool parse_place(const Entry& entry, Write& write) {
  const Entry* coil = child(entry, "coil");
  const Entry* place = coil != nullptr ? coil : child(entry, "holding_register");
  if (place == nullptr) return false;
  write.write.table = coil != nullptr ? Table::coils : Table::holding_registers;
  write.at_heartbeat = place->text == "heartbeat";
  const auto address = word(*place);
  write.write.address = address.value_or(0);
  return address || write.at_heartbeat;
}

bool parse_value(const Entry& entry, Write& write) {
  const Entry* value = child(entry, "value");
  if (value == nullptr) return false;
  if (value->text == "timeout") {
    const Entry* unit = child(entry, "unit");
    write.unit = (unit != nullptr ? parse_duration(unit->text) : std::nullopt).value_or(write.unit);
    return write.unit.count() > 0;
  }
  const auto given = word(*value);
  write.write.value = given.value_or(0);
  return given.has_value();
}

/// A list of writes; false if one of them makes no sense.
bool parse_sequence(const Entry& list, std::vector<Write>& sequence) {
  for (const Entry& element : list.children) {
    Write& write = sequence.emplace_back();
    if (!parse_place(element, write) || !parse_value(element, write)) return false;
    if (const Entry* flag = child(element, "if_different"))
      write.write.if_different = parse_boolean(flag->text).value_or(false);
  }
  return list.kind == Entry::Kind::list;
}

bool parse_feed(const Entry& entry, std::vector<Write>& feed) {
  const Entry* values = child(entry, "values");
  Write write;
  if (values == nullptr || !parse_place(entry, write)) return false;
  for (const Entry& element : values->children) {
    const auto value = word(element);
    if (!value) return false;
    write.write.value = *value;
    feed.push_back(write);
  }
  return !feed.empty();
}

bool parse_expired(const Entry& entry, PresetWatchdog& watchdog) {
  if (const auto code = word(entry, "exception")) {
    watchdog.refusal = static_cast<modbus::Exception>(*code);
    return *code > 0 && *code < 0x100;
  }
  Write alarm;
  if (!parse_place(entry, alarm) || !parse_value(entry, alarm)) return false;
  watchdog.alarm = alarm.write;
  return !alarm.at_heartbeat && alarm.unit.count() == 0;
}

bool parse_part(const Entry& part, PresetWatchdog& watchdog) {
  if (part.key == "arm") return parse_sequence(part, watchdog.arm);
  if (part.key == "reset") return parse_sequence(part, watchdog.reset);
  if (part.key == "feed") return parse_feed(part, watchdog.feed);
  return part.key == "expired" && parse_expired(part, watchdog);
}

}  // namespace

tl::expected<PresetWatchdog, Position> parse_preset_watchdog(const Entry& entry) {
  PresetWatchdog watchdog;
  for (const Entry& part : entry.children)
    if (!parse_part(part, watchdog)) return tl::make_unexpected(part.key_at);
  return watchdog;
}

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
