// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/csv_row.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/codec/type_name.hpp"
#include "coupler/map/loader/keys.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/tools/formats/csv_values.hpp"
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

class TableReader {
 public:
  TableReader(const std::vector<Column>& columns, const ImportOptions& options, const std::vector<Row>& rows,
              char separator, Questions& questions, Problems& problems)
      : columns_(columns),
        options_(options),
        rows_(rows),
        separator_(separator),
        questions_(questions),
        problems_(problems) {
    const bool has_access = std::any_of(columns.begin(), columns.end(),
                                        [](const Column& column) { return column.key == "access"; });
    codes_are_access_ = !has_access && std::any_of(rows.begin() + 1, rows.end(), [this](const Row& row) {
      const Codes codes = table_word(view(row), Holds::anything).codes;
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
    const RowView cells = view(row);
    RowPoint point;
    if (const Cell* type = cells.cell("type")) point.type = read_type_cell(type->text);
    if (!read_address(cells, point)) return;
    Codes codes = Codes::none;
    if (!read_table(cells, point, codes) || !check_type(cells, point)) return;
    const Cell* name = cells.at("name");
    const loader::Position at = name != nullptr ? name->at : row.front().at;
    point.entry = section(name != nullptr ? name->text : "", at);
    for (std::size_t i = 0; i < row.size(); ++i) add(cells, i, point);
    add_access(cells, codes, point);
    add_size(cells, point);
    add_scale(cells, point);
    add_range(cells, point);
    add_order(cells, point);
    Entry& map = unit_of(cells, units).map;
    if (options_.addressing == loader::Addressing::modicon) set(map, scalar("addressing", "modicon", map.at));
    Entry& mapping = make_section(map, "mapping", at);
    make_section(mapping, to_string(point.table), at).children.push_back(std::move(point.entry));
  }

 private:
  RowView view(const Row& row) const {
    return {rows_.front(), columns_, row, options_, separator_, questions_, problems_};
  }

  bool read_address(const RowView& row, RowPoint& point) const {
    const Cell* cell = row.cell("address");
    if (cell == nullptr) {
      const Cell* empty = row.at("address");
      problems_.error(empty != nullptr ? empty->at : row.row.back().at, "the point has no address",
                      "write it in the column of addresses, or remove the row");
      return false;
    }
    point.address = read_address_cell(cell->text, point.type, options_.addressing);
    if (point.address.what.empty()) return true;
    problems_.error(cell->at, point.address.what, point.address.remedy);
    return false;
  }

  /// The table that the cells name, or the address.
  bool read_table(const RowView& row, RowPoint& point, Codes& codes) const {
    const Cell& address = *row.cell("address");
    const Cell* given = row.cell("table");
    if (given == nullptr && point.address.table) {
      point.table = *point.address.table;
      return true;
    }
    const bool is_number = point.type.type && *point.type.type != codec::Type::BOOL;
    const bool is_bit = point.address.bit || row.cell("bit") != nullptr;
    const TableWord word = table_word(row, is_number || is_bit ? Holds::registers : Holds::anything);
    codes = word.codes;
    if (given == nullptr)
      tell_missing_table(row);
    else if (!word.table)
      problems_.error(given->at, word.what, word.remedy);
    else if (point.address.table && *point.address.table != *word.table)
      problems_.error(address.at,
                      fmt::format("{} is in {}, but the row says {}", shown(address.text),
                                  to_string(*point.address.table), to_string(*word.table)),
                      "correct one of the two");
    else {
      point.table = *word.table;
      return true;
    }
    return false;
  }

  void tell_missing_table(const RowView& row) const {
    const Cell& address = *row.cell("address");
    const Cell* empty = row.at("table");
    const bool is_modicon = options_.addressing == loader::Addressing::modicon;
    problems_.error(empty != nullptr ? empty->at : address.at,
                    fmt::format("the address {} does not say its table", shown(address.text)),
                    empty != nullptr ? "write the table into this cell"
                    : is_modicon     ? "write it in six digits, the table's first, or add a column 'table'"
                                     : "add a column 'table'");
  }

  /// A register's type is needed; a bit's is not.
  bool check_type(const RowView& row, const RowPoint& point) const {
    const Cell* type = row.at("type");
    if (type == nullptr || !type->text.empty() || holds_bits(point.table) || point.address.bit) return true;
    problems_.error(type->at, "the point has no type", "write what its registers hold, as in INT");
    return false;
  }

  TableWord table_word(const RowView& row, Holds holds) const {
    const Cell* given = row.cell("table");
    if (given == nullptr) return formats::read_table("", false);
    const Column& column = row.column_of(*given);
    return formats::read_table(given->text, column.reading == Reading::function_codes, holds);
  }

  void add(const RowView& row, std::size_t i, RowPoint& point) {
    const Column& column = columns_[i];
    const Cell& given = row.row[i];
    if (column.described == nullptr) return;
    if (column.reading == Reading::bytes && point.type.type != codec::Type::STRING) return;
    const bool is_unticked = column.reading == Reading::may_be_written && is_writable(point.table);
    if (given.text.empty() && !is_unticked) return;
    const loader::Key* own = loader::find_key(column.key, loader::section_of(point.table));
    const loader::Key& key = own != nullptr ? *own : *column.described;
    // A coil's type is BOOL whether it is said or not.
    if (column.key == "type" && holds_bits(point.table) && point.type.type == codec::Type::BOOL) return;
    const bool text = is_text(key, point.type.type == codec::Type::STRING);
    if (!text) {
      if (auto entry = structured(given, problems_)) {
        entry->key = column.key;
        point.entry.children.push_back(std::move(*entry));
        return;
      }
    }
    Entry entry = scalar(column.key, std::string(text ? unguarded(given.text) : given.text), given.at, text);
    if (column.key == "access") entry.text = access_of(given.text, column.reading);
    if (column.key == "type") entry.text = point.type.text;
    if (column.key == "address") entry.text = with_offset(row, point.address.text);
    if (!text && refuse_thousands(row, given)) return;
    if (!text && has_decimal_comma(entry.text)) {
      std::replace(entry.text.begin(), entry.text.end(), ',', '.');
      problems_.warning(given.at, fmt::format("{} is read as {}", shown(given.text), entry.text),
                        "write a decimal point");
    }
    if (column.key == "scale") entry.text = factor_text(entry.text, column.reading);
    point.entry.children.push_back(std::move(entry));
  }

  /// The address, and what the column `address_offset` adds to it.
  std::string with_offset(const RowView& row, const std::string& address) const {
    const Cell* offset = row.cell("address_offset");
    if (offset == nullptr) return address;
    const auto first = loader::parse_unsigned(address);
    const auto added = loader::parse_unsigned(offset->text);
    constexpr std::uint64_t most = 1'000'000;  // more than any address, in Modicon's numbers, too
    if (!first || !added || *first > most || *added > most) {
      problems_.error(offset->at, fmt::format("{} cannot be added to the address", shown(offset->text)),
                      "write a whole number that is not negative, or nothing");
      return address;
    }
    return fmt::format("{:0>{}}", *first + *added, address.substr(0, 2) == "0x" ? 1 : address.size());
  }

  void add_access(const RowView& row, Codes codes, RowPoint& point) const {
    const Cell* table = row.cell("table");
    if (codes_are_access_ && codes == Codes::read && is_writable(point.table))
      point.entry.children.push_back(scalar("access", "read", table->at));
    if (codes != Codes::write || loader::child(point.entry, "access") != nullptr) return;
    point.entry.children.push_back(scalar("access", "write", table->at));
    problems_.warning(table->at,
                      fmt::format("{} only writes, so the point gets 'access: write'", shown(table->text)),
                      "add the function code that reads it, or a column 'access'");
  }

  ForeignUnit& unit_of(const RowView& row, std::vector<ForeignUnit>& units) {
    std::optional<unsigned> wanted;
    if (const Cell* given = row.cell("unit")) {
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
    unit.map = section("", row.row.front().at);
    return units.emplace_back(std::move(unit));
  }

  const std::vector<Column>& columns_;
  const ImportOptions& options_;
  const std::vector<Row>& rows_;
  char separator_;
  Questions& questions_;
  Problems& problems_;
  bool codes_are_access_ = false;  ///< some have one that writes, and nothing else says what may be written
};

}  // namespace

const Cell* RowView::at(std::string_view key) const {
  for (std::size_t i = 0; i < std::min(row.size(), columns.size()); ++i)
    if (columns[i].key == key) return &row[i];
  return nullptr;
}

const Cell* RowView::cell(std::string_view key) const {
  const Cell* found = at(key);
  return found != nullptr && !found->text.empty() ? found : nullptr;
}

std::vector<ForeignUnit> read_rows(const std::vector<Column>& columns, const ImportOptions& options,
                                   const std::vector<Row>& rows, char separator, Problems& problems) {
  std::vector<ForeignUnit> units;
  Questions questions;
  TableReader reader(columns, options, rows, separator, questions, problems);
  for (auto row = rows.begin() + 1; row != rows.end(); ++row) reader.read(*row, units);
  questions.tell(problems);
  return units;
}

}  // namespace coupler::formats
