// SPDX-License-Identifier: Apache-2.0
#include "common/map/loader/preset.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "common/map/loader/document.hpp"
#include "common/map/loader/nearest.hpp"
#include "common/map/loader/scalar.hpp"

namespace coupler::loader {
namespace {

const Entry* child(const Entry& entry, std::string_view key) {
  const auto found = std::find_if(entry.children.begin(), entry.children.end(),
                                  [&](const Entry& e) { return e.key == key; });
  return found == entry.children.end() ? nullptr : &*found;
}

std::optional<std::uint32_t> number(const Entry& entry, std::string_view key) {
  const Entry* found = child(entry, key);
  const auto value = found != nullptr ? parse_unsigned(found->text) : std::nullopt;
  if (!value || *value > 0xFFFF) return std::nullopt;
  return static_cast<std::uint32_t>(*value);
}

std::optional<Preset::Area> area_of(const Entry& entry) {
  const Entry* name = child(entry, "table");
  const auto from = number(entry, "from");
  const auto to = number(entry, "to");
  if (name == nullptr || !from || !to || *to < *from) return std::nullopt;
  for (const Table table : tables)
    if (name->text == to_string(table)) return Preset::Area{table, modbus::Range::of(*from, *to - *from + 1)};
  return std::nullopt;
}

std::string areas_of(const Preset& preset, Table table) {
  std::string text;
  for (const Preset::Area& area : preset.areas)
    if (area.table == table)
      text += fmt::format("{}{} … {}", text.empty() ? "" : ", ", area.range.start(), area.range.last());
  return text;
}

void check_area(const Preset& preset, const DraftPoint& draft, Context& context) {
  const Point& point = draft.point;
  const std::string there = areas_of(preset, point.table);
  const bool inside = std::any_of(preset.areas.begin(), preset.areas.end(), [&](const Preset::Area& area) {
    return area.table == point.table && area.range.contains(range(point));
  });
  if (there.empty() || inside) return;
  context.problems.warning(draft.address_at,
                           fmt::format("{} is where a {} has nothing: its {} are {} on the wire",
                                       shown(point.name), preset.name, to_string(point.table), there),
                           "look into its manual, or remove 'preset'");
}

}  // namespace

tl::expected<Preset, std::string> parse_preset(const PresetFile& file) {
  Problems problems(file.name);
  const auto root = parse_document(file.text, problems);
  if (!root) return tl::make_unexpected(to_string(std::move(problems).sorted().front()));
  Preset preset;
  preset.name = file.name;
  for (const Entry& entry : root->children) {
    if (entry.key == "map") {
      preset.map = entry;
      continue;
    }
    for (const Entry& element : entry.children) {
      const auto area = area_of(element);
      const auto offset = number(element, "offset");
      if (!area || (entry.key != "areas" && !(entry.key == "read_back" && offset)))
        return tl::make_unexpected(
            fmt::format("{}: line {} is no element of '{}'", file.name, element.at.line, entry.key));
      if (offset)
        preset.read_back.push_back({*area, static_cast<std::uint16_t>(*offset)});
      else
        preset.areas.push_back(*area);
    }
  }
  return preset;
}

std::optional<Preset> read_preset(const Entry& root, Context& context) {
  const Entry* entry = child(root, "preset");
  if (entry == nullptr) return std::nullopt;
  std::vector<std::string_view> names;
  for (const PresetFile& file : preset_files()) {
    names.push_back(file.name);
    if (file.name == entry->text) return parse_preset(file).value();
  }
  context.problems.error(entry->at, fmt::format("no preset is called {}", shown(*entry)),
                         suggestion(entry->text, names));
  return std::nullopt;
}

Entry completed(Entry root, const Preset& preset) {
  for (const Entry& key : preset.map.children) {
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

void apply(const Preset& preset, DraftPoints& points, Context& context) {
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
