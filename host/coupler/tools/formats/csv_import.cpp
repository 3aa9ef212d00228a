// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <unordered_map>

#include <fmt/format.h>

#include "coupler/base/lower.hpp"
#include "coupler/map/loader/document.hpp"
#include "coupler/map/table.hpp"
#include "coupler/tools/formats/csv.hpp"
#include "coupler/tools/formats/csv_header.hpp"
#include "coupler/tools/formats/csv_meanings.hpp"
#include "coupler/tools/formats/csv_row.hpp"
#include "coupler/tools/formats/importers.hpp"
#include "coupler/tools/formats/map_tree.hpp"
#include "coupler/tools/formats/spelling.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::Problems;
using loader::shown;

bool has_letter(std::string_view text) {
  return std::any_of(text.begin(), text.end(), [](char c) { return c >= 'a' && c <= 'z'; });
}

/// Returns false, with an error, if the name cannot be spelt.
bool spell(Entry& point, Problems& problems) {
  std::string unknown;
  const auto spelt = in_ascii(point.key, unknown);
  if (!spelt || !has_letter(*spelt)) {
    problems.error(point.key_at,
                   spelt ? fmt::format("the name {} has no letter from a to z", shown(point.key))
                         : fmt::format("the name {} has {}, which has no spelling in the letters a to z",
                                       shown(point.key), shown(unknown)),
                   "give the point a name of a to z, digits and '_'; this one may be its description");
    return false;
  }
  std::string name = mended_name(*spelt, "point");
  if (loader::child(point, "description") == nullptr)
    point.children.push_back(scalar("description", point.key, point.key_at, true));
  problems.warning(
      point.key_at,
      fmt::format("{} is not a valid name of a point and was changed to '{}'", shown(point.key), name),
      "change it in the map if you prefer another name");
  point.key = std::move(name);
  return true;
}

struct Named {
  std::string given;
  loader::Position at;
  bool was_spelt = false;
};

void spell_names_of(Entry& mapping, Problems& problems) {
  std::unordered_map<std::string, Named> names;
  for (Entry& table : mapping.children)
    for (Entry& point : table.children) {
      Named named{point.key, point.key_at, needs_spelling(point.key)};
      if (named.was_spelt && !spell(point, problems)) {
        point.key = fmt::format("point_of_line_{}", point.key_at.line);  // nothing more is reported of it
        continue;
      }
      const auto [other, is_first] = names.emplace(lower(mended_name(point.key, "point")), named);
      if (is_first || (!named.was_spelt && !other->second.was_spelt)) continue;
      problems.error(named.at,
                     fmt::format("{} and {} in line {} would both be called '{}'", shown(named.given),
                                 shown(other->second.given), other->second.at.line, other->first),
                     "give one of the two another name", {{other->second.at, "the other is here"}});
      point.key = fmt::format("point_of_line_{}", point.key_at.line);
    }
}

/// Spells names that have other letters than those of ASCII in small letters of ASCII ("Ölstand" becomes
/// "oelstand"), and reports each. It is an error if a letter has no such spelling, or if another point then
/// has the same name.
void spell_names(std::vector<ForeignUnit>& units, Problems& problems) {
  for (ForeignUnit& unit : units)
    if (Entry* mapping = find(unit.map, "mapping")) spell_names_of(*mapping, problems);
}

/// `safe` of a point with nothing behind it on a node: what the driver leaves. nullptr if no point has one.
const Entry* safe_for_the_driver(const Entry& map) {
  const Entry* mapping = loader::child(map, "mapping");
  for (const Table table : {Table::coils, Table::holding_registers}) {
    const Entry* points = mapping != nullptr ? loader::child(*mapping, to_string(table)) : nullptr;
    if (points == nullptr) continue;
    for (const Entry& point : points->children) {
      const Entry* safe = loader::child(point, "safe");
      const bool wired = table == Table::coils ? loader::child(point, "line") != nullptr
                                               : loader::child(point, "iio") != nullptr ||
                                                     loader::child(point, "pwm") != nullptr;
      if (safe != nullptr && !wired) return safe;
    }
  }
  return nullptr;
}

void add_on_shutdown(Entry& map, Problems& problems) {
  const Entry* safe = safe_for_the_driver(map);
  if (safe == nullptr) return;
  const loader::Position at = safe->at;
  set(map, scalar("on_shutdown", "safe", at));
  problems.warning(at,
                   "'safe' of a point without a line, 'iio' or 'pwm' is the value that the driver writes "
                   "when it ends, so the map has 'on_shutdown: safe'",
                   "empty these cells if the driver should leave outputs as they are");
}

}  // namespace

std::vector<ForeignUnit> read_csv(std::string_view text, const ImportOptions& options, Problems& problems) {
  std::vector<Row> rows = parse_csv(text, problems);
  if (problems.has_errors()) return {};
  if (rows.size() < 2) {
    problems.error({1, 1}, "there are no points in the file",
                   "write a line of headings and one line for each point");
    return {};
  }
  std::vector<Column> columns = read_header(rows, options, problems);
  if (problems.has_errors()) return {};
  decide_meanings(columns, rows, problems);
  if (problems.has_errors()) return {};
  std::vector<ForeignUnit> units = read_rows(columns, options, rows, separator_of(text), problems);
  spell_names(units, problems);
  for (ForeignUnit& unit : units) add_on_shutdown(unit.map, problems);
  return units;
}

}  // namespace coupler::formats
