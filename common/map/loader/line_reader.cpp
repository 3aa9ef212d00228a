// SPDX-License-Identifier: Apache-2.0
#include "common/map/loader/line_reader.hpp"

#include <array>

#include <fmt/format.h>

#include "common/map/loader/scalar.hpp"
#include "common/map/loader/value_reader.hpp"

namespace coupler::loader {
namespace {

/// The options of a line that its table has; beside `line` and inside it they are the same.
std::vector<std::string_view> option_keys(Table table) {
  return {"active_low", "bias", table == Table::coils ? "drive" : "debounce"};
}

void read_options(const Reader& reader, Table table, Line& line) {
  reader.boolean("active_low", line.active_low);
  reader.choice("bias", {Bias::none, Bias::pull_up, Bias::pull_down}, line.bias);
  if (table == Table::coils)
    reader.choice("drive", {Drive::push_pull, Drive::open_drain, Drive::open_source}, line.drive);
  else
    reader.duration("debounce", line.debounce);
}

void refuse_without_line(const Reader& point, Table table, Context& context) {
  for (const std::string_view key : option_keys(table))
    if (const Entry* entry = point.find(key))
      context.problems.error(entry->key_at,
                             fmt::format("'{}' is for a point with a GPIO line, this one has none", key),
                             "add 'line: {chip: gpiochip0, offset: 17}', or remove it");
}

/// One word for all of an array's coils, or a list.
void read_safe(const Reader& reader, DraftPoint& draft, Context& context) {
  Point& point = draft.point;
  const Entry* entry = reader.find("safe");
  if (entry == nullptr || entry->kind != Entry::Kind::list || point.count == 1)
    return reader.choice("safe", {Safe::off, Safe::on, Safe::hold}, point.safe);
  if (!draft.placed) return;
  point.safe = Safe::on;
  point.safe_value = read_value("safe", *entry, point, context);
}

void read_place(const Reader& reader, const Entry& entry, Line& line, Context& context) {
  const bool by_offset = reader.has("chip") && reader.has("offset");
  if (by_offset == reader.has("name") || reader.has("chip") != reader.has("offset")) {
    context.problems.error(entry.key_at, "'line' has either 'chip' and 'offset' or 'name'",
                           "write it as in 'line: {chip: gpiochip0, offset: 17}' or 'line: GPIO17'");
    return;
  }
  reader.text("chip", line.chip);
  reader.integer("offset", line.offset);
  reader.text("name", line.name);
  for (const std::string_view key : {"chip", "name"})
    if (const Entry* given = reader.find(key);
        given != nullptr && given->kind == Entry::Kind::scalar && given->text.empty())
      reader.wrong(key, "a name");
}

}  // namespace

void read_line(const Reader& point, DraftPoint& draft, Context& context) {
  const Table table = draft.point.table;
  const Entry* entry = point.find("line");
  if (table == Table::coils) read_safe(point, draft, context);
  if (entry == nullptr) return refuse_without_line(point, table, context);
  Line& line = draft.point.line;
  draft.line_at = entry->at;
  read_options(point, table, line);
  if (entry->kind == Entry::Kind::map) {
    const Reader inside(*entry, table == Table::coils ? Section::coil_line : Section::input_line, context);
    read_place(inside, *entry, line, context);
    read_options(inside, table, line);
    for (const std::string_view key : option_keys(table))
      if (point.has(key) && inside.has(key))
        context.problems.error(
            inside.find(key)->key_at,
            fmt::format("'{}' is given twice, also in line {}", key, point.find(key)->key_at.line),
            "keep one of the two", {{point.find(key)->key_at, "the other is here"}});
  } else if (entry->kind == Entry::Kind::scalar && !entry->text.empty() && !parse_unsigned(entry->text)) {
    line.name = context.map.keep(entry->text);
  } else {
    point.wrong("line", "the name of a GPIO line, or its chip and offset");
  }
}

}  // namespace coupler::loader
