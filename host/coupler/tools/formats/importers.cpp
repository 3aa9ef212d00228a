// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/importers.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <tuple>
#include <unordered_map>

#include <fmt/format.h>

#include "coupler/codec/type_name.hpp"
#include "coupler/map/loader/map_reader.hpp"
#include "coupler/map/loader/names.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/loader/source_text.hpp"
#include "coupler/map/printable.hpp"
#include "coupler/tools/formats/map_tree.hpp"
#include "coupler/tools/formats/spelling.hpp"
#include "coupler/tools/formats/text_encoding.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::Problems;

constexpr Importer all_importers[] = {
    {"csv", "a table of points: one row a point, one column a key", read_csv, true},
    {"origin", "bitmeal/ros-modbus-device-driver, YAML or JSON", read_ros_modbus_device_driver},
    {"unslave", "Unslave's config.json", read_unslave},
#ifdef COUPLER_WITH_PUGIXML
    {"modbuspal", "a ModbusPal project (.xmpp)", read_modbuspal},
#endif
    {"home-assistant", "the key modbus: of Home Assistant's configuration.yaml", read_home_assistant, false,
     true},
    {"pymodbus", "the JSON of pymodbus' simulator", read_pymodbus, false, true},
};

constexpr std::size_t longest = 100;  // for a name that was changed: a topic stays readable

std::string valid(std::string_view name) {
  if (!loader::is_relative_ros_name(name)) return mended_name(name, "point");
  if (loader::is_driver_topic(name)) return std::string(name) + "_point";
  return std::string(name);
}

/// Names that are taken, and the line of the point that has each.
class Names {
 public:
  explicit Names(Problems& problems) : problems_(problems) {}

  void mend(Entry& point) {
    const std::string wanted = valid(point.key);
    std::string name = wanted;
    int& last = last_.emplace(wanted, 1).first->second;
    while (!lines_.emplace(name, point.key_at.line).second) name = fmt::format("{}_{}", wanted, ++last);
    if (wanted != point.key && !point.key.empty() && loader::child(point, "description") == nullptr)
      point.children.push_back(scalar("description", point.key, point.key_at, true));
    if (wanted != point.key)
      problems_.warning(point.key_at,
                        fmt::format("{} is not a valid name of a point and was changed to '{}'",
                                    loader::shown(point.key), name),
                        "change it in the map if you prefer another name");
    else if (name != wanted)
      problems_.warning(
          point.key_at,
          fmt::format("{} is already the name of the point in line {}, so this point is called '{}'",
                      loader::shown(wanted), lines_[wanted], name),
          "give every point a name of its own");
    point.key = name;
  }

 private:
  Problems& problems_;
  std::unordered_map<std::string, int> lines_;
  std::unordered_map<std::string, int> last_;  ///< number that was given behind a name
};

/// Gives every point of the tree a valid name of its own, and warns of each one that it changed.
void mend_point_names(Entry& map, Problems& problems) {
  Entry* mapping = find(map, "mapping");
  if (mapping == nullptr) return;
  Names names(problems);
  for (const Table table : tables)
    if (Entry* entry = find(*mapping, to_string(table)))
      for (Entry& point : entry->children) names.mend(point);
}

/// A map that is written has the types' names of IEC 61131-3.
void spell_types(Entry& map) {
  Entry* mapping = find(map, "mapping");
  if (mapping == nullptr) return;
  for (Entry& table : mapping->children)
    for (Entry& point : table.children)
      if (Entry* given = find(point, "type"); given != nullptr && given->kind == Entry::Kind::scalar)
        if (const auto type = codec::parse_type(given->text)) given->text = to_string(*type);
}

std::string_view base_name(std::string_view path) { return path.substr(path.rfind('/') + 1); }

/// "Line 4.csv" -> "Line_4"
std::string name_from_file(std::string_view file) {
  const std::string_view base = base_name(file);
  return mended_name(base.substr(0, base.rfind('.')), "device");
}

void set_name(Entry& map, const ImportOptions& options, std::string_view file, const std::string& suffix) {
  if (!options.name.empty())
    set(map, scalar("name", options.name + suffix, map.at));
  else if (loader::child(map, "name") == nullptr)
    set(map, scalar("name", name_from_file(file) + suffix, map.at));
}

std::string list_of(const std::vector<ForeignUnit>& units) {
  std::string text;
  for (const ForeignUnit& unit : units)
    if (unit.unit) text += fmt::format("{}{}", text.empty() ? "" : ", ", *unit.unit);
  return text;
}

/// Leaves the one that was asked for.
void choose_unit(std::vector<ForeignUnit>& units, unsigned wanted, Problems& problems) {
  if (units.size() == 1 && !units.front().unit) {
    units.front().unit = wanted;
    return;
  }
  const std::string there = list_of(units);
  units.erase(std::remove_if(units.begin(), units.end(),
                             [wanted](const ForeignUnit& unit) { return unit.unit != wanted; }),
              units.end());
  if (units.empty() && !problems.has_errors())
    problems.error({}, fmt::format("there is no unit {} in the file", wanted),
                   there.empty() ? "leave --unit out" : fmt::format("give one of {} with --unit", there));
}

void check_units(const std::vector<ForeignUnit>& units, Problems& problems) {
  for (auto unit = units.begin(); unit != units.end(); ++unit)
    if (std::any_of(units.begin(), unit, [&](const ForeignUnit& other) { return other.unit == unit->unit; }))
      problems.error(unit->map.at, fmt::format("unit {} is there twice", unit->unit.value_or(0)),
                     "give every unit a number of its own");
}

bool has_points(const Entry& map) {
  const Entry* mapping = loader::child(map, "mapping");
  return mapping != nullptr && std::any_of(mapping->children.begin(), mapping->children.end(),
                                           [](const Entry& table) { return !table.children.empty(); });
}

/// Leaves out units without points, if there are several. A single map without points is an error of its own.
void leave_out_empty_units(std::vector<ForeignUnit>& units, Problems& problems) {
  const bool any =
      std::any_of(units.begin(), units.end(), [](const auto& unit) { return has_points(unit.map); });
  if (!any) return;
  const auto is_empty = [&](const ForeignUnit& unit) {
    if (has_points(unit.map)) return false;
    problems.warning(unit.map.at,
                     fmt::format("unit {} has no points, so there is no map of it", unit.unit.value_or(0)),
                     "no action is needed");
    return true;
  };
  units.erase(std::remove_if(units.begin(), units.end(), is_empty), units.end());
}

ImportedMap finish(const ForeignUnit& foreign, std::string_view comment, Problems& problems) {
  const auto map = std::make_shared<OwnedMap>();
  std::string text = write_map(foreign.map, comment);
  loader::Placement no_lock{"", {}, {}};
  loader::read_map(foreign.map, {text}, no_lock, problems, *map);
  for (const Diagnostic& diagnostic : no_lock.problems)
    problems.error({diagnostic.line, diagnostic.column}, diagnostic.what, diagnostic.remedy);
  return {foreign.unit, std::move(text), map};
}

/// A newline in a file's name would end the comment.
std::string comment_of(const Importer& importer, std::string_view file) {
  return fmt::format("Imported from {} by `coupler import {}`.", printable(base_name(file)), importer.name);
}

Diagnostics quoted(Problems&& problems, std::string_view text) {
  Diagnostics diagnostics = std::move(problems).sorted();
  // What stands behind an alias is read at each of its places, and told once.
  std::set<std::tuple<int, int, std::string>> told;
  const auto is_told = [&](const Diagnostic& each) {
    return !told.emplace(each.line, each.column, each.what).second;
  };
  diagnostics.erase(std::remove_if(diagnostics.begin(), diagnostics.end(), is_told), diagnostics.end());
  quote(diagnostics, text);
  return diagnostics;
}

}  // namespace

std::string mended_name(std::string_view name, std::string_view prefix) {
  std::string unknown;
  const std::string spelt =
      needs_spelling(name) ? in_ascii(name, unknown).value_or(std::string(name)) : std::string(name);
  std::string out;
  for (const char c : spelt) {
    if (out.size() == longest) break;
    const bool keeps = loader::is_letter(c) || loader::is_digit(c);
    const bool joins = !out.empty() && out.back() != '_' && out.back() != '/';
    if (keeps)
      out += c;
    else if (joins)
      out += c == '/' ? '/' : '_';
  }
  while (!out.empty() && (out.back() == '_' || out.back() == '/')) out.pop_back();
  if (out.empty()) return std::string(prefix);
  return loader::is_letter(out.front()) ? out : fmt::format("{}_{}", prefix, out);
}

Span<const Importer> importers() { return all_importers; }

const Importer* find_importer(std::string_view name) {
  const auto* found = std::find_if(std::begin(all_importers), std::end(all_importers),
                                   [name](const Importer& importer) { return importer.name == name; });
  return found == std::end(all_importers) ? nullptr : found;
}

ImportResult import_text(const Importer& importer, std::string_view text, std::string_view file,
                         const ImportOptions& options) {
  Problems problems(file);
  Utf8 converted;
  if (importer.is_table) {
    converted = to_utf8(text);
    text = converted.text;
    if (converted.from == WrittenIn::windows_1252)
      problems.warning({}, "the file is not UTF-8, so it is read as Windows-1252 (Latin-1)",
                       "save it as UTF-8 if texts look wrong");
  }
  text = loader::without_byte_order_mark(text);
  if (!loader::check_text(text, problems)) return {{}, quoted(std::move(problems), text)};
  std::vector<ForeignUnit> units = importer.read(text, options, problems);
  check_units(units, problems);
  const bool several = units.size() > 1;
  if (options.unit) choose_unit(units, *options.unit, problems);
  if (!options.unit) leave_out_empty_units(units, problems);
  std::vector<ImportedMap> maps;
  for (ForeignUnit& unit : units) {
    set_name(unit.map, options, file, several && unit.unit ? fmt::format("_{}", *unit.unit) : "");
    const loader::Position unit_at = unit.unit_at.line > 0 ? unit.unit_at : unit.map.at;
    if (unit.unit) set(unit.map, scalar("unit", fmt::to_string(*unit.unit), unit_at));
    mend_point_names(unit.map, problems);
    spell_types(unit.map);
    maps.push_back(finish(unit, comment_of(importer, file), problems));
  }
  if (problems.has_errors()) maps.clear();
  return {std::move(maps), quoted(std::move(problems), text)};
}

}  // namespace coupler::formats
