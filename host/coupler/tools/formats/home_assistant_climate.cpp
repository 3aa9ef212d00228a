// SPDX-License-Identifier: Apache-2.0
// A climate is a temperature, its target, and registers for modes.
#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "coupler/tools/formats/home_assistant_points.hpp"
#include "coupler/tools/formats/map_tree.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;

/// Registers of the target, by what stands behind the climate's name.
using Targets = std::vector<std::pair<std::string, unsigned>>;

/// One register, or seven: one for each mode, in Home Assistant's order.
Targets targets_of(Settings& settings) {
  constexpr std::string_view modes[] = {"auto", "cool", "dry", "fan_only", "heat", "heat_cool", "off"};
  Targets out;
  const Entry* given = settings.find("target_temp_register");
  if (given == nullptr || given->kind != Entry::Kind::list) {
    if (const auto address = settings.whole("target_temp_register", 65535))
      out.emplace_back("_target", *address);
    return out;
  }
  std::size_t mode = 0;
  for (const Entry& each : given->children) {
    const auto address = whole_of(each, 65535, settings.problems());
    if (!address || mode == std::size(modes)) {
      settings.problems().error(each.at, "'target_temp_register' is not an address or a list of seven",
                                "write a number from 0 to 65535, or seven of them");
      return {};
    }
    if (std::none_of(out.begin(), out.end(), [&](const auto& other) { return other.second == *address; }))
      out.emplace_back(fmt::format("_target_{}", modes[mode]), *address);
    ++mode;
  }
  if (out.size() == 1) out[0].first = "_target";
  return out;
}

struct Modes {
  std::string_view key;
  std::string_view suffix;
  std::string_view prefix;  ///< of its values' keys
  PointUse use;
};
constexpr Modes all_modes[] = {{"hvac_mode_register", "_mode", "state_", PointUse::both},
                               {"fan_mode_register", "_fan_mode", "state_fan_", PointUse::both},
                               {"swing_mode_register", "_swing_mode", "swing_mode_state_", PointUse::both},
                               {"hvac_action_register", "_action", "action_", PointUse::read}};

void add_modes(const Modes& which, Entity& entity) {
  Settings& settings = entity.settings();
  const Entry* given = settings.find(which.key);
  if (given == nullptr) return;
  Settings modes(*given, settings.problems());
  Names names;
  if (const Entry* values = modes.find("values"))
    for (const Entry& value : values->children) {
      const bool prefixed = value.key.compare(0, which.prefix.size(), which.prefix) == 0;
      entity.add_numbers(value, prefixed ? value.key.substr(which.prefix.size()) : value.key, names);
    }
  const Table table = Entity::table_of("input_type", "holding", modes);
  const bool write_registers = modes.flag("write_registers");
  const Entry* address = modes.find("address");
  // A list of one address is one that Home Assistant writes with function code 16.
  const bool is_list =
      address != nullptr && address->kind == Entry::Kind::list && address->children.size() == 1;
  if (is_list) address = &address->children[0];
  const auto number = address != nullptr ? whole_of(*address, 65535, settings.problems()) : std::nullopt;
  if (number) {
    FoundPoint found = entity.named(std::string(which.suffix), table, *number, which.use, names);
    found.write_multiple = write_registers || is_list;
    entity.add(std::move(found));
  } else {
    settings.problems().error(given->at, fmt::format("'{}' has no address", which.key),
                              "give it one from 0 to 65535");
  }
  modes.report_rest();
}

class Temperatures {
 public:
  explicit Temperatures(Entity& entity)
      : entity_(entity),
        gain_(entity.settings().number("scale").value_or(1)),
        offset_(entity.settings().number("offset").value_or(0)),
        units_(entity.settings().text("temperature_unit", "C") == "F" ? "\u00B0F" : "\u00B0C"),
        write_multiple_(entity.settings().flag("target_temp_write_registers")),
        values_(read_data_type(entity.settings())) {}

  void add(const std::string& suffix, Table table, unsigned address, PointUse use, std::string_view kind) {
    Settings& settings = entity_.settings();
    for (const RegisterValue& value : values_) {
      FoundPoint found = entity_.with_value(value, suffix, table, address, use);
      if (value.is_number)
        entity_.scale(found, settings.number(fmt::format("{}_temp_scale", kind)).value_or(gain_),
                      settings.number(fmt::format("{}_temp_offset", kind)).value_or(offset_));
      found.write_multiple = write_multiple_;
      found.entry.children.push_back(scalar("units", units_, entity_.given().at, true));
      entity_.add(std::move(found));
    }
  }

 private:
  Entity& entity_;
  double gain_;
  double offset_;
  std::string units_;
  bool write_multiple_;  ///< the target
  std::vector<RegisterValue> values_;
};

}  // namespace

void add_climate(Entity& entity) {
  Settings& settings = entity.settings();
  const Table table = Entity::table_of("input_type", "holding", settings);
  Temperatures temperatures(entity);
  // Points that can be written get their places first.
  for (const auto& [suffix, address] : targets_of(settings))
    temperatures.add(suffix, Table::holding_registers, address, PointUse::both, "target");
  temperatures.add("", table, entity.address(), PointUse::read, "current");
  for (const Modes& modes : all_modes) add_modes(modes, entity);
  const unsigned on = settings.whole("hvac_on_value", 65535).value_or(1);
  const unsigned off = settings.whole("hvac_off_value", 65535).value_or(0);
  const bool write_registers = settings.flag("write_registers");  // of this register only
  if (const auto address = settings.whole("hvac_onoff_register", 65535)) {
    FoundPoint found = entity.named("_onoff", Table::holding_registers, *address, PointUse::both,
                                    {{off, "off"}, {on, "on"}});
    found.write_multiple = write_registers;
    entity.add(std::move(found));
  }
  if (const auto address = settings.whole("hvac_onoff_coil", 65535))
    entity.add(entity.point("_onoff", Table::coils, *address, PointUse::both));
  for (const std::string_view key : {"min_temp", "max_temp"})
    if (settings.find(key) != nullptr)
      entity.lose(fmt::format("'{}' is not carried over", key), "give the target's point 'min' and 'max'",
                  key);
}

}  // namespace coupler::formats
