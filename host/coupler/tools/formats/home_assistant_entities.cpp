// SPDX-License-Identifier: Apache-2.0
// What each platform of the integration reads and writes: homeassistant/components/modbus, one file each.
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>

#include <fmt/format.h>

#include "coupler/map/loader/scalar.hpp"
#include "coupler/tools/formats/home_assistant_points.hpp"
#include "coupler/tools/formats/map_tree.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;

constexpr unsigned most_elements = 2000;

void warn_of_reading_only(Table table, Entity& entity) {
  if (is_writable(table))
    entity.lose("sensors only read, so these points get 'access: read'",
                "remove it where the host shall write");
}

/// Returns whether the text is a whole number that has room in so many registers, with a sign or as bits.
bool fits(std::string_view text, unsigned registers) {
  const unsigned bits = std::min(16 * registers, 64U);
  if (const auto number = loader::parse_unsigned(text)) return *number <= ~std::uint64_t{0} >> (64 - bits);
  const auto negative = loader::parse_integer(text);
  return negative && *negative >= std::numeric_limits<std::int64_t>::min() >> (64 - bits);
}

void add_sensor(Entity& entity) {
  Settings& settings = entity.settings();
  const Table table = Entity::table_of("input_type", "holding", settings);
  const double gain = settings.number("scale").value_or(1);
  const double offset = settings.number("offset").value_or(0);
  const std::string units = settings.text("unit_of_measurement", "");
  const std::string none = settings.text("nan_value", "");
  for (const std::string_view key : {"min_value", "max_value", "zero_suppress"})
    if (settings.find(key) != nullptr)
      entity.lose(fmt::format("'{}' changes what Home Assistant shows and is not carried over", key),
                  "a map publishes what the device holds; 'min' and 'max' say what is to be expected", key);
  warn_of_reading_only(table, entity);
  for (const RegisterValue& value : read_data_type(settings)) {
    FoundPoint found = entity.with_value(value, "", table, entity.address(), PointUse::read);
    if (value.is_number) entity.scale(found, gain, offset);
    if (value.is_number && !none.empty()) {
      if (fits(none, value.registers))
        found.entry.children.push_back(scalar("invalid", none, entity.given().at));
      else
        entity.lose(fmt::format("'nan_value: {}' does not fit into the registers", none),
                    "write what the device gives for no value as 'invalid', as in 'invalid: 0x8000'",
                    "nan_value");
    }
    if (!units.empty()) found.entry.children.push_back(scalar("units", units, entity.given().at, true));
    entity.add(std::move(found));
  }
}

void add_binary_sensor(Entity& entity) {
  Settings& settings = entity.settings();
  const Table table = Entity::table_of("input_type", "coil", settings);
  const unsigned count = elements_of(settings, most_elements);
  const loader::Position at = entity.given().at;
  warn_of_reading_only(table, entity);
  if (holds_bits(table)) {
    FoundPoint found = entity.point("", table, entity.address(), PointUse::read);
    found.size = count;
    if (count > 1) found.entry.children.push_back(scalar("count", fmt::to_string(count), at));
    return entity.add(std::move(found));
  }
  for (unsigned i = 0; i < count; ++i) {
    FoundPoint found =
        entity.point(count > 1 ? fmt::format("_{}", i) : "", table, entity.address() + i, PointUse::read);
    found.mask = 1;
    found.entry.children = {scalar("type", "BOOL", at), scalar("bit", "0", at)};
    entity.add(std::move(found));
  }
}

/// `state_off` and `state_on`, each a number or several; as the commands if they are not given.
Names states_of(Settings& verify, const Entity& entity, const Names& commands) {
  Names states;
  for (const auto& [number, name] : commands)
    if (const Entry* given = verify.find("state_" + name))
      entity.add_numbers(*given, name, states);
    else
      states.emplace(number, name);
  return states;
}

void read_verify(FoundPoint& found, Entity& entity, const Names& commands) {
  const Entry none = section("verify", entity.given().at);
  const Entry* given = loader::child(entity.given(), "verify");
  Settings verify(given->kind == Entry::Kind::map ? *given : none, entity.settings().problems());
  const unsigned address = verify.whole("address", 65535).value_or(found.address);
  const Table table = Entity::table_of("input_type", Entity::word_of(found.table), verify);
  const Names states = states_of(verify, entity, commands);
  verify.ignore("delay");  // Home Assistant waits before it looks; the driver reads all the time
  verify.report_rest();
  if (table != found.table) return entity.add(entity.named("_state", table, address, PointUse::read, states));
  found.use = PointUse::both;
  found.read_address = address;
  if (!holds_bits(table) && states != commands)
    entity.lose("'state_on' and 'state_off' other than the commands are not carried over",
                "compare with the number that the point publishes", "verify");
}

void add_light_part(std::string_view key, const std::string& suffix, Entity& entity) {
  const auto address = entity.settings().whole(key, 65535);
  if (!address || *address == 0) return;  // Home Assistant takes 0 for none
  // It reads them in every update, even without `verify`, and writes them with function code 6.
  FoundPoint part = entity.named(suffix, Table::holding_registers, *address, PointUse::both, {});
  part.entry.children.push_back(scalar("max", "100", entity.given().at));
  part.entry.children.push_back(scalar("units", "%", entity.given().at, true));
  entity.add(std::move(part));
}

/// Switches, lights and fans.
void add_toggle(bool is_light, Entity& entity) {
  Settings& settings = entity.settings();
  const Table table = Entity::table_of("write_type", "holding", settings);
  const unsigned on = settings.whole("command_on", 65535).value_or(1);
  const unsigned off = settings.whole("command_off", 65535).value_or(0);
  const Names commands = {{off, "off"}, {on, "on"}};
  if (holds_bits(table) && on == 0)
    entity.lose("Home Assistant switches these on by writing 0, but a point has the coil's own state",
                "write false to switch it on", "command_on");
  FoundPoint found = entity.named("", table, entity.address(), PointUse::write, commands);
  found.write_multiple = Entity::writes_multiple("write_type", settings);
  const bool verified = loader::child(entity.given(), "verify") != nullptr;  // without a value, too
  settings.ignore("verify");
  if (verified)
    read_verify(found, entity, commands);
  else
    entity.lose("without 'verify' the output is only written, so the point gets 'access: write'",
                "remove it if the device can read it back");
  entity.add(std::move(found));
  if (!is_light) return;
  add_light_part("brightness_address", "_brightness", entity);
  add_light_part("color_temp_address", "_color_temp", entity);
  for (const std::string_view key : {"min_temp", "max_temp"})
    if (settings.find(key) != nullptr)
      entity.lose("the colour temperature at 0 % and at 100 % is not carried over",
                  "write it into the description", key);
}

void add_cover(Entity& entity) {
  Settings& settings = entity.settings();
  const Table table = Entity::table_of("input_type", "holding", settings);
  const unsigned closed = settings.whole("state_closed", 65535).value_or(0);
  const unsigned open = settings.whole("state_open", 65535).value_or(1);
  const unsigned opening = settings.whole("state_opening", 65535).value_or(2);
  const unsigned closing = settings.whole("state_closing", 65535).value_or(3);
  const Names all = {{closed, "closed"}, {open, "open"}, {opening, "opening"}, {closing, "closing"}};
  const Table status_table = Entity::table_of("status_register_type", "holding", settings);
  const auto status = settings.whole("status_register", 65535);
  if (!status || *status == 0)  // Home Assistant takes 0 for none
    return entity.add(entity.named("", table, entity.address(), PointUse::both, all));
  entity.add(
      entity.named("", table, entity.address(), PointUse::write, {{closed, "closed"}, {open, "open"}}));
  entity.add(entity.named("_status", status_table, *status, PointUse::read, all));
}

constexpr std::string_view platforms[] = {"climates", "covers",         "lights", "fans",
                                          "switches", "binary_sensors", "sensors"};

}  // namespace

Span<const std::string_view> entity_platforms() { return platforms; }

void add_entity(std::string_view platform, const Entry& given, HubPoints& points, ConversionWarnings& losses,
                loader::Problems& problems) {
  Entity entity(given, points, losses, problems);
  if (!entity.read_place()) return;
  if (platform == "sensors")
    add_sensor(entity);
  else if (platform == "binary_sensors")
    add_binary_sensor(entity);
  else if (platform == "covers")
    add_cover(entity);
  else if (platform == "climates")
    add_climate(entity);
  else
    add_toggle(platform == "lights", entity);
  entity.report_rest();
}

}  // namespace coupler::formats
