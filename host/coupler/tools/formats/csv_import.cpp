// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/document.hpp"
#include "coupler/map/table.hpp"
#include "coupler/tools/formats/csv.hpp"
#include "coupler/tools/formats/csv_header.hpp"
#include "coupler/tools/formats/csv_meanings.hpp"
#include "coupler/tools/formats/csv_names.hpp"
#include "coupler/tools/formats/csv_row.hpp"
#include "coupler/tools/formats/importers.hpp"
#include "coupler/tools/formats/map_tree.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::Problems;

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
