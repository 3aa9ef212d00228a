// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/point_reader.hpp"

#include <array>

#include <fmt/format.h>

#include "coupler/map/loader/scalar.hpp"

namespace coupler::loader {
namespace {

/// The options of a line in this table. They may stand beside `line` or inside it.
std::vector<std::string_view> option_keys(Table table) {
  return {"active_low", "bias", table == Table::coils ? "drive" : "debounce"};
}

void refuse_without_line(const Reader& point, Table table, const Context& context) {
  for (const std::string_view key : option_keys(table))
    if (const Entry* entry = point.find(key))
      context.problems.error(entry->key_at,
                             fmt::format("'{}' is for a point with a GPIO line, but this one has none", key),
                             "add 'line: {chip: gpiochip0, offset: 17}', or remove it");
}

/// One word for all of an array's coils, or a list.
void read_safe_bits(const Reader& reader, DraftPoint& draft, const Context& context) {
  Point& point = draft.point;
  const Entry* entry = reader.find("safe");
  if (entry == nullptr || entry->kind != Entry::Kind::list || point.count == 1)
    return reader.choice("safe", point.safe);
  if (!draft.placed) return;
  point.safe = Safe::on;
  point.safe_value = read_value("safe", *entry, point, context);
}

bool check_place(const Reader& reader, const Entry& entry, const Context& context) {
  const bool by_offset = reader.has("chip") && reader.has("offset");
  if (by_offset == reader.has("name") || reader.has("chip") != reader.has("offset")) {
    context.problems.error(entry.key_at, "'line' needs either 'chip' and 'offset' or 'name'",
                           "write it as in 'line: {chip: gpiochip0, offset: 17}' or 'line: GPIO17'");
    return false;
  }
  for (const std::string_view key : {"chip", "name"})
    if (const Entry* given = reader.find(key);
        given != nullptr && given->kind == Entry::Kind::scalar && given->text.empty())
      reader.wrong(key, "a name");
  return true;
}

/// The reader of a channel. Nothing if it lacks a required key, which is a problem.
std::optional<Reader> channel(const Reader& point, std::string_view key, std::string_view expected,
                              DraftPoint& draft, const Context& context) {
  const Entry* entry = point.find(key);
  if (entry == nullptr) return std::nullopt;
  draft.line_at = entry->at;
  auto reader = point.inside(key, expected);
  if (!reader || reader->missing().empty()) return reader;
  if (reader->lacks(reader->missing()))
    context.problems.error(entry->key_at, fmt::format("'{}' has no '{}'", key, reader->missing()),
                           fmt::format("write it as in '{}: {}'", key, point.example(key)));
  return std::nullopt;
}

void check_name(const Reader& reader, std::string_view key, std::string_view name) {
  if (name.empty()) reader.wrong(key, "a name");
}

void read_iio(const Reader& point, DraftPoint& draft, const Context& context) {
  const auto reader = channel(point, "iio", "a map of 'device' and 'channel'", draft, context);
  if (!reader) return;
  Iio& iio = draft.point.iio;
  reader->fields(iio);
  check_name(*reader, "device", iio.device);
  check_name(*reader, "channel", iio.channel);
}

void read_pwm(const Reader& point, DraftPoint& draft, const Context& context) {
  const auto reader = channel(point, "pwm", "a map of 'chip', 'channel' and 'period'", draft, context);
  if (!reader) return;
  Pwm& pwm = draft.point.pwm;
  reader->fields(pwm);
  check_name(*reader, "chip", pwm.chip);
}

void check_type(const Entry& channel, const Point& point, const Context& context) {
  if (codec::is_scalable(point.format.type) && !codec::is_partial(point.format)) return;
  context.problems.error(channel.key_at,
                         fmt::format("'{}' does not apply to {}", channel.key, to_string(point.format.type)),
                         "use a type that is a number in registers of its own: INT to ULINT, REAL or LREAL");
}

void read_safe_value(const Reader& reader, DraftPoint& draft, const Context& context) {
  const Entry* entry = reader.find("safe");
  if (entry == nullptr) return;
  Point& point = draft.point;
  const bool word = entry->kind == Entry::Kind::scalar;
  if (word && entry->text == "hold") {
    point.safe = Safe::hold;
  } else if (draft.placed && !(is_analogue(point) && word && parse_boolean(entry->text) == false)) {
    point.safe = Safe::on;
    point.safe_value = read_value("safe", *entry, point, context);
  }
}

}  // namespace

void read_line(const Reader& point, DraftPoint& draft, const Context& context) {
  const Table table = draft.point.table;
  const Entry* entry = point.find("line");
  if (table == Table::coils) read_safe_bits(point, draft, context);
  if (entry == nullptr) return refuse_without_line(point, table, context);
  Line& line = draft.point.line;
  draft.line_at = entry->at;
  point.fields(line);
  if (entry->kind == Entry::Kind::map) {
    const Reader inside(*entry, table == Table::coils ? Section::coil_line : Section::input_line, context);
    inside.fields(line);
    if (!check_place(inside, *entry, context)) line.chip = line.name = {};
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

void read_channel(const Reader& reader, DraftPoint& draft, const Context& context) {
  const bool holding = draft.point.table == Table::holding_registers;
  read_iio(reader, draft, context);
  if (holding) read_pwm(reader, draft, context);
  const Entry* iio = reader.find("iio");
  const Entry* pwm = holding ? reader.find("pwm") : nullptr;
  if (const Entry* channel = iio != nullptr ? iio : pwm) {
    if (draft.placed) check_type(*channel, draft.point, context);
    if (const Entry* counter = reader.find("counter"))
      context.problems.error(counter->key_at,
                             fmt::format("a point is a 'counter' or has '{}', not both", channel->key),
                             "remove one of the two");
  }
  if (iio != nullptr && pwm != nullptr)
    context.problems.error(pwm->key_at, "a point has 'iio' or 'pwm', not both", "remove one of the two");
  if (holding) read_safe_value(reader, draft, context);
}

}  // namespace coupler::loader
