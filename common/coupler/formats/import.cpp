// SPDX-License-Identifier: Apache-2.0
#include "coupler/formats/import.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/formats/entries.hpp"
#include "coupler/formats/map_writer.hpp"
#include "coupler/formats/names.hpp"
#include "coupler/map/loader/map_reader.hpp"
#include "coupler/map/loader/source_text.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::Problems;

std::string_view base_name(std::string_view path) { return path.substr(path.rfind('/') + 1); }

/// "Line 4.csv" -> "Line_4"
std::string name_from_file(std::string_view file) {
  const std::string_view base = base_name(file);
  return mended_name(base.substr(0, base.rfind('.')), "device");
}

void set_name(Entry& map, const ImportOptions& options, std::string_view file, const std::string& suffix) {
  if (!options.name.empty())
    set(map, scalar("name", options.name + suffix, map.at));
  else if (find(map, "name") == nullptr)
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
  quote(diagnostics, text);
  return diagnostics;
}

}  // namespace

ImportResult import_text(const Importer& importer, std::string_view text, std::string_view file,
                         const ImportOptions& options) {
  Problems problems(file);
  text = loader::without_byte_order_mark(text);
  if (!loader::check_text(text, problems)) return {{}, quoted(std::move(problems), text)};
  std::vector<ForeignUnit> units = importer.read(text, problems);
  check_units(units, problems);
  const bool several = units.size() > 1;
  if (options.unit) choose_unit(units, *options.unit, problems);
  std::vector<ImportedMap> maps;
  for (ForeignUnit& unit : units) {
    set_name(unit.map, options, file, several && unit.unit ? fmt::format("_{}", *unit.unit) : "");
    if (unit.unit) set(unit.map, scalar("unit", fmt::to_string(*unit.unit), unit.map.at));
    mend_point_names(unit.map, problems);
    maps.push_back(finish(unit, comment_of(importer, file), problems));
  }
  if (problems.has_errors()) maps.clear();
  return {std::move(maps), quoted(std::move(problems), text)};
}

}  // namespace coupler::formats
