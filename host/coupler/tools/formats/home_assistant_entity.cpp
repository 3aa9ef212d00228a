// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include "coupler/tools/formats/home_assistant_points.hpp"
#include "coupler/tools/formats/home_assistant_text.hpp"
#include "coupler/tools/formats/map_tree.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::shown;

constexpr unsigned usual_interval = 15;      // seconds
constexpr unsigned longest_interval = 1000;  // a map's slowest rate is 0.001 Hz

struct Input {
  std::string_view word;
  Table table;
};
constexpr Input inputs[] = {{"coil", Table::coils},
                            {"coils", Table::coils},
                            {"discrete_input", Table::discrete_inputs},
                            {"input", Table::input_registers},
                            {"holding", Table::holding_registers},
                            {"holdings", Table::holding_registers}};

/// The keys of each platform that only Home Assistant uses.
constexpr std::string_view own_keys[] = {"unique_id", "device_class",     "state_class",
                                         "precision", "lazy_error_count", "temp_step"};

}  // namespace

const Entry* unit_of(const Entry& entity) {
  const Entry* address = loader::child(entity, "device_address");
  return address != nullptr ? address : loader::child(entity, "slave");
}

void Entity::lose(std::string_view what, std::string_view remedy, std::string_view key) {
  const Entry* place = loader::child(given_, key);
  if (place == nullptr) place = loader::child(given_, "name");
  losses_.add(what, remedy, name_, place != nullptr ? place->key_at : given_.at);
}

void Entity::add(FoundPoint point) {
  const Entry* unit = unit_of(given_);
  UnitPoints& points = points_[unit_];
  points.begin_at(unit != nullptr ? unit->at : given_.at);
  points.add(std::move(point), settings_.problems());
}

bool Entity::read_place() {
  name_ = settings_.text("name", "");
  const auto address = settings_.whole("address", 65535);
  const auto slave = settings_.whole("slave", 255);
  unit_ = settings_.whole("device_address", 255).value_or(slave.value_or(1));
  interval_ = settings_.whole("scan_interval", 31'536'000).value_or(usual_interval);
  const Entry* place = loader::child(given_, "address");
  const bool is_secret = place != nullptr && !secret_of(*place).empty();  // which has been reported
  if (name_.empty() || (settings_.find("address") == nullptr && !is_secret))
    settings_.problems().error(
        given_.at, fmt::format("an entity without '{}'", name_.empty() ? "name" : "address"), "give it one");
  if (name_.empty() || !address) return false;
  address_ = *address;
  if (interval_ == 0)
    lose("what is never read by itself ('scan_interval: 0') is read at the map's rate",
         "give the points a 'rate'", "scan_interval");
  if (interval_ > longest_interval) {
    lose("entities are read every 1000 s at least", "no action is needed", "scan_interval");
    interval_ = longest_interval;
  }
  return true;
}

void Entity::report_rest() {
  for (const std::string_view key : own_keys)
    if (settings_.find(key) != nullptr)
      lose(fmt::format("'{}' belongs to Home Assistant and is not carried over", key), "no action is needed",
           key);
  settings_.report_rest();
}

Table Entity::table_of(std::string_view key, std::string_view fallback, Settings& settings) {
  const std::string word = settings.text(key, fallback);
  for (const Input& input : inputs)
    if (input.word == word) return input.table;
  settings.problems().error(settings.at(), fmt::format("'{}' is {}, which is not a table", key, shown(word)),
                            "write coil, discrete_input, input or holding");
  return Table::holding_registers;
}

bool Entity::writes_multiple(std::string_view key, Settings& settings) {
  const Entry* word = settings.find(key);
  return word != nullptr && (word->text == "coils" || word->text == "holdings");
}

std::string_view Entity::word_of(Table table) {
  const auto* last = std::end(inputs) - 1;  // for holding registers, so that one is always found
  return std::find_if(std::begin(inputs), last, [table](const Input& i) { return i.table == table; })->word;
}

FoundPoint Entity::point(const std::string& suffix, Table table, unsigned address, PointUse use) const {
  FoundPoint point;
  point.entry = section(name_ + suffix, given_.at);
  point.table = table;
  point.address = address;
  point.use = use;
  point.interval = interval_;
  return point;
}

FoundPoint Entity::named(const std::string& suffix, Table table, unsigned address, PointUse use,
                         const Names& names) const {
  FoundPoint found = point(suffix, table, address, use);
  if (holds_bits(table)) return found;
  found.entry.children.push_back(scalar("type", "UINT", given_.at));
  Entry values = section("values", given_.at);
  for (const auto& [number, name] : names)
    values.children.push_back(scalar(fmt::to_string(number), name, given_.at, true));
  if (!values.children.empty()) found.entry.children.push_back(std::move(values));
  return found;
}

FoundPoint Entity::with_value(const RegisterValue& value, const std::string& suffix, Table table,
                              unsigned address, PointUse use) const {
  FoundPoint found = point(suffix + value.suffix, table, address + value.register_offset, use);
  found.size = value.registers;
  found.mask = value.mask;
  found.entry.children = value.keys;
  return found;
}

void Entity::scale(FoundPoint& point, double gain, double offset) const {
  if (gain == 1 && offset == 0) return;
  Entry scale = scalar("scale", fmt::to_string(gain), given_.at);
  if (offset != 0) {
    scale = section("scale", given_.at);
    scale.children = {scalar("gain", fmt::to_string(gain), given_.at),
                      scalar("offset", fmt::to_string(offset), given_.at)};
  }
  point.entry.children.push_back(std::move(scale));
}

void Entity::add_numbers(const Entry& given, const std::string& name, Names& names) const {
  const bool is_list = given.kind == Entry::Kind::list;
  int n = 0;
  for (const Entry& each : is_list ? Span<const Entry>(given.children) : Span<const Entry>(&given, 1)) {
    const auto number = whole_of(each, 65535, settings_.problems());
    if (!number) {
      settings_.problems().error(each.at, fmt::format("{} is not what a register can hold", shown(each.text)),
                                 "write a number from 0 to 65535");
      continue;
    }
    ++n;
    names.emplace(*number, n > 1 ? fmt::format("{}_{}", name, n) : name);
  }
}

}  // namespace coupler::formats
