// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/importers.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/codec/type_name.hpp"
#include "coupler/map/loader/document.hpp"
#include "coupler/map/loader/keys.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/table.hpp"
#include "coupler/tools/formats/csv.hpp"
#include "coupler/tools/formats/csv_header.hpp"
#include "coupler/tools/formats/csv_words.hpp"
#include "coupler/tools/formats/map_tree.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::Problems;
using loader::shown;

void place(Entry& entry, loader::Position at) {
  entry.key_at = at;
  entry.at = at;
  for (Entry& child : entry.children) place(child, at);
}

/// "{of: pulse}" and "[1, 2]", as they stand in a map; nullopt if it is a plain text.
std::optional<Entry> structured(const Cell& cell, Problems& problems) {
  if (cell.text.empty() || (cell.text[0] != '{' && cell.text[0] != '[')) return std::nullopt;
  Problems inside("");
  auto entry = loader::parse_document(cell.text, inside);
  if (!entry) {
    for (const Diagnostic& diagnostic : std::move(inside).sorted())
      problems.error(cell.at, diagnostic.what, diagnostic.remedy);
    return Entry{};
  }
  place(*entry, cell.at);
  return entry;
}

/// "0,5" for 0.5.
bool has_decimal_comma(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos || text.find(',', comma + 1) != std::string_view::npos) return false;
  std::string number(text);
  number[comma] = '.';
  return loader::parse_number(number).has_value();
}

class RowReader {
 public:
  RowReader(const std::vector<Column>& columns, const ImportOptions& options, const std::vector<Row>& rows,
            Problems& problems)
      : columns_(columns), options_(options), problems_(problems) {
    const bool has_access = std::any_of(columns.begin(), columns.end(),
                                        [](const Column& column) { return column.key == "access"; });
    codes_are_access_ = !has_access && std::any_of(rows.begin() + 1, rows.end(), [this](const Row& row) {
      const Codes codes = table_word(row, cell(row, "table")).codes;
      return codes == Codes::write || codes == Codes::read_and_write;
    });
  }

  void read(const Row& row, std::vector<ForeignUnit>& units) {
    if (row.size() > columns_.size()) {
      problems_.error(
          row[columns_.size()].at,
          fmt::format("the row has {} cells, but there are {} headings", row.size(), columns_.size()),
          "put text that contains the separator in quotes");
      return;
    }
    const Cell* name = cell(row, "name");
    const Cell* table_cell = cell(row, "table");
    Codes codes = Codes::none;
    const auto table = table_of(row, table_cell, codes);
    if (!table) return;
    const loader::Position at = name != nullptr ? name->at : row.front().at;
    Entry point = section(name != nullptr ? name->text : "", at);
    for (std::size_t i = 0; i < row.size(); ++i)
      if (columns_[i].described != nullptr &&
          (!row[i].text.empty() || (columns_[i].reading == Reading::may_be_written && is_writable(*table))))
        add(columns_[i], row[i], row, *table, point);
    if (codes_are_access_ && codes == Codes::read && is_writable(*table))
      point.children.push_back(scalar("access", "read", table_cell->at));
    if (codes == Codes::write && loader::child(point, "access") == nullptr) {
      point.children.push_back(scalar("access", "write", table_cell->at));
      problems_.warning(
          table_cell->at,
          fmt::format("{} only writes, so the point gets 'access: write'", shown(table_cell->text)),
          "add the function code that reads it, or a column 'access'");
    }
    Entry& map = unit_of(row, units).map;
    if (options_.addressing == loader::Addressing::modicon) set(map, scalar("addressing", "modicon", map.at));
    Entry& mapping = make_section(map, "mapping", at);
    make_section(mapping, to_string(*table), at).children.push_back(std::move(point));
  }

 private:
  std::optional<Table> table_of(const Row& row, const Cell* given, Codes& codes) const {
    if (given == nullptr && options_.addressing == loader::Addressing::modicon)
      if (const Cell* address = cell(row, "address"))
        if (const auto table = table_of_modicon(address->text)) return table;
    const TableWord word = table_word(row, given);
    codes = word.codes;
    if (!word.table) problems_.error(given != nullptr ? given->at : row.front().at, word.what, word.remedy);
    return word.table;
  }

  TableWord table_word(const Row& row, const Cell* given) const {
    if (given == nullptr) return read_table("", false);
    const Column& column = columns_[static_cast<std::size_t>(given - row.data())];
    return read_table(given->text, column.reading == Reading::function_codes);
  }

  const Cell* cell(const Row& row, std::string_view key) const {
    for (std::size_t i = 0; i < std::min(row.size(), columns_.size()); ++i)
      if (columns_[i].key == key && !row[i].text.empty()) return &row[i];
    return nullptr;
  }

  bool is_string(const Row& row) const {
    const Cell* type = cell(row, "type");
    return type != nullptr && codec::parse_type(type->text) == codec::Type::STRING;
  }

  void add(const Column& column, const Cell& given, const Row& row, Table table, Entry& point) {
    const loader::Key* own = loader::find_key(column.key, loader::section_of(table));
    const loader::Key& key = own != nullptr ? *own : *column.described;
    // A coil's type is BOOL whether it is said or not.
    if (column.key == "type" && holds_bits(table) && codec::parse_type(given.text) == codec::Type::BOOL)
      return;
    const bool text = is_text(key, is_string(row));
    if (!text) {
      if (auto entry = structured(given, problems_)) {
        entry->key = column.key;
        point.children.push_back(std::move(*entry));
        return;
      }
    }
    Entry entry = scalar(column.key, std::string(text ? unguarded(given.text) : given.text), given.at, text);
    if (column.key == "access") entry.text = access_of(given.text, column.reading);
    if (!text && has_decimal_comma(given.text)) {
      std::replace(entry.text.begin(), entry.text.end(), ',', '.');
      problems_.warning(given.at, fmt::format("{} is read as {}", shown(given.text), entry.text),
                        "write a decimal point");
    }
    if (column.reading == Reading::divisor)
      if (const auto factor = factor_of(entry.text)) entry.text = fmt::format("{}", *factor);
    point.children.push_back(std::move(entry));
  }

  ForeignUnit& unit_of(const Row& row, std::vector<ForeignUnit>& units) {
    std::optional<unsigned> wanted;
    if (const Cell* given = cell(row, "unit")) {
      const auto number = loader::parse_unsigned(given->text);
      if (number && *number <= 255)
        wanted = static_cast<unsigned>(*number);
      else
        problems_.error(given->at, fmt::format("{} is not a unit id", shown(given->text)),
                        "write a number from 0 to 255");
    }
    for (ForeignUnit& unit : units)
      if (unit.unit == wanted) return unit;
    ForeignUnit unit;
    unit.unit = wanted;
    unit.map = section("", row.front().at);
    return units.emplace_back(std::move(unit));
  }

  const std::vector<Column>& columns_;
  const ImportOptions& options_;
  Problems& problems_;
  bool codes_are_access_ = false;  ///< some have one that writes, and nothing else says what may be written
};

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
  const std::vector<Row> rows = parse_csv(text, problems);
  if (problems.has_errors()) return {};
  if (rows.size() < 2) {
    problems.error({1, 1}, "there are no points in the file",
                   "write a line of headings and one line for each point");
    return {};
  }
  std::vector<Column> columns = read_header(rows.front(), options, problems);
  if (problems.has_errors()) return {};
  tell_units_from_unit_ids(columns, rows);
  refuse_two_meanings(columns, rows, problems);
  if (problems.has_errors()) return {};
  std::vector<ForeignUnit> units;
  RowReader reader(columns, options, rows, problems);
  for (auto row = rows.begin() + 1; row != rows.end(); ++row) reader.read(*row, units);
  for (ForeignUnit& unit : units) add_on_shutdown(unit.map, problems);
  return units;
}

}  // namespace coupler::formats
