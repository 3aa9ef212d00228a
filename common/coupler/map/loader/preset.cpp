// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/preset.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "coupler/codec/type_name.hpp"
#include "coupler/map/loader/document.hpp"
#include "coupler/map/nearest.hpp"

namespace coupler::loader {
namespace {

std::optional<Preset::Area> area_of(const Entry& entry) {
  const Entry* name = child(entry, "table");
  const auto from = word(entry, "from");
  const auto to = word(entry, "to");
  if (name == nullptr || !from || !to || *to < *from) return std::nullopt;
  for (const Table table : tables)
    if (name->text == to_string(table))
      return Preset::Area{table, modbus::Range::of(*from, *to - *from + 1U)};
  return std::nullopt;
}

std::string areas_of(const Preset& preset, Table table) {
  std::string text;
  for (const Preset::Area& area : preset.areas)
    if (area.table == table)
      text += fmt::format("{}{} to {}", text.empty() ? "" : ", ", area.range.start(), area.range.last());
  return text;
}

void check_area(const Preset& preset, const DraftPoint& draft, const Context& context) {
  const Point& point = draft.point;
  const std::string there = areas_of(preset, point.table);
  const bool inside = std::any_of(preset.areas.begin(), preset.areas.end(), [&](const Preset::Area& area) {
    return area.table == point.table && area.range.contains(range(point));
  });
  if (there.empty() || inside) return;
  context.problems.warning(draft.address_at,
                           fmt::format("{} is at an address that a {} does not have: its {} are {}",
                                       shown(point.name), preset.name, to_string(point.table), there),
                           "see its manual, or remove 'preset'");
}

std::vector<std::string> texts_of(const Entry& list) {
  std::vector<std::string> texts;
  texts.reserve(list.children.size());
  for (const Entry& element : list.children) texts.push_back(element.text);
  return texts;
}

std::string no_element(const PresetFile& file, Position at, std::string_view of) {
  return fmt::format("{}: line {} is not an element of '{}'", file.name, at.line, of);
}

/// Adds an element of `areas` or `read_back`. Returns false if it is none.
bool add_element(const Entry& element, std::string_view list, Preset& preset) {
  const auto area = area_of(element);
  const auto offset = word(element, "offset");
  if (!area || (list != "areas" && !(list == "read_back" && offset))) return false;
  if (offset)
    preset.read_back.push_back({*area, *offset});
  else
    preset.areas.push_back(*area);
  return true;
}

}  // namespace

tl::expected<Preset, std::string> parse_preset(const PresetFile& file) {
  Problems problems(file.name);
  const auto root = parse_document(file.text, problems);
  if (!root) return tl::make_unexpected(to_string(std::move(problems).sorted().front()));
  if (child(*root, "watchdog") == nullptr)
    return tl::make_unexpected(fmt::format("{}: nothing is said of a 'watchdog'", file.name));
  Preset preset;
  preset.name = file.name;
  for (const Entry& entry : root->children) {
    if (entry.key == "map") {
      preset.map = entry;
      continue;
    }
    if (entry.key == "watchdog") {
      const auto watchdog = parse_preset_watchdog(entry);
      if (!watchdog) return tl::make_unexpected(no_element(file, watchdog.error(), entry.key));
      preset.watchdog = *watchdog;
      continue;
    }
    if (entry.key == "models") {
      preset.models = texts_of(entry);
      continue;
    }
    for (const Entry& element : entry.children)
      if (!add_element(element, entry.key, preset))
        return tl::make_unexpected(no_element(file, element.at, entry.key));
  }
  return preset;
}

std::string_view preset_of_model(std::string_view model) {
  const std::string folded = codec::folded_type_name(model);
  for (const PresetFile& file : preset_files()) {
    const Preset preset = parse_preset(file).value();
    for (const std::string& part : preset.models)
      if (folded.find(codec::folded_type_name(part)) != std::string::npos) return file.name;
  }
  return {};
}

std::optional<Preset> read_preset(const Entry& root, const Context& context) {
  const Entry* entry = child(root, "preset");
  if (entry == nullptr) return std::nullopt;
  std::vector<std::string_view> names;
  for (const PresetFile& file : preset_files()) {
    names.push_back(file.name);
    if (file.name == entry->text) return parse_preset(file).value();
  }
  const std::string_view of_model = preset_of_model(entry->text);
  context.problems.error(
      entry->at, fmt::format("no preset is called {}", shown(*entry)),
      context.unless_served(
          of_model.empty() ? nearest_or(entry->text, names,
                                        or_update(fmt::format("write one of {}", fmt::join(names, ", "))))
                           : fmt::format("write '{}', which covers this model", of_model)));
  return std::nullopt;
}

Entry completed(Entry root, const Preset& preset) {
  for (const Entry& key : preset.map.children) {
    if (key.key == "serial") continue;  // says how a port is set, not that there is one: read_connection()
    const auto own = std::find_if(root.children.begin(), root.children.end(),
                                  [&](const Entry& e) { return e.key == key.key; });
    if (own == root.children.end())
      root.children.push_back(key);
    else if (own->kind == Entry::Kind::map)
      for (const Entry& inner : key.children)
        if (child(*own, inner.key) == nullptr) own->children.push_back(inner);
  }
  return root;
}

void apply(const Preset& preset, DraftPoints& points, const Context& context) {
  for (DraftPoint& draft : points) {
    if (!draft.placed) continue;
    Point& point = draft.point;
    check_area(preset, draft, context);
    if (point.read_address || !is_readable(point)) continue;
    for (const Preset::ReadBack& back : preset.read_back)
      if (back.from.table == point.table && back.from.range.contains(range(point)))
        point.read_address = static_cast<std::uint16_t>(point.address + back.offset);
  }
}

}  // namespace coupler::loader
