// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/dump_output.hpp"

#include <algorithm>
#include <array>
#include <sstream>

#include <fmt/format.h>

#include "coupler/base/utc_text.hpp"
#include "coupler/docs/point_description.hpp"
#include "coupler/host/core/value_text.hpp"
#include "coupler/map/node_address.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::tools {
namespace {

using State = Reading::State;
using Cells = std::array<std::string, 6>;  // point, value, type, table, address, Modicon

/// Characters of UTF-8.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string padded(const std::string& text, std::size_t to) {
  return text + std::string(to > width(text) ? to - width(text) : 0, ' ');
}

std::string why_not(const Reading& reading) {
  switch (reading.state) {
    case State::failed: return "not read: " + reading.why;
    case State::invalid: return "invalid: " + reading.why;
    case State::fault: return "fault: " + reading.why;
    default: return reading.why;
  }
}

std::string good_value(const Point& point, const Reading& reading) {
  std::string text = printable(host::format_value(reading.registers.data(), point));
  if (point.format.type == codec::Type::STRING && point.count == 1) text = '"' + text + '"';
  return point.units.empty() ? text : fmt::format("{} {}", text, printable(point.units));
}

/// Returns the cells of a point's row. Its place is the one at which it is read, written as in the register
/// map of `coupler generate --docs`.
Cells cells_of(const Map& map, const Reading& reading) {
  Point point = map.points[reading.point];
  point.address = read_range(point).start();
  const docs::PointDescription text = docs::describe(point, 0);
  return {text.name,
          reading.state == State::good ? good_value(point, reading) : "-",
          text.count.empty() ? text.type : fmt::format("{}[{}]", text.type, text.count),
          std::string(to_string(point.table)),
          text.part.empty() ? text.address : fmt::format("{}, {}", text.address, text.part),
          text.modicon};
}

std::string head(const Map& map, const Snapshot& now) {
  const std::string where =
      printable(fmt::format("{} at {}, {}", map.name, node_address_text(map.connection), utc_text(now.at)));
  if (now.error) return fmt::format("{}: offline: {}", where, printable(host::to_string(*now.error)));
  if (const std::size_t failed = now.failed(); failed > 0)
    return fmt::format("{}: {} of {} points not read", where, failed, now.readings.size());
  const auto none = std::count_if(now.readings.begin(), now.readings.end(), [](const Reading& reading) {
    return reading.state == State::invalid || reading.state == State::fault;
  });
  return fmt::format("{}: {} point{}{}", where, now.readings.size(), now.readings.size() == 1 ? "" : "s",
                     none == 0 ? "" : fmt::format(", {} without a value", none));
}

void add_lines(std::vector<std::string>& lines, const std::string& text) {
  std::istringstream rest(text);
  for (std::string line; std::getline(rest, line);) lines.push_back(printable(line));
}

}  // namespace

std::string value_text(const Map& map, const Reading& reading) {
  return reading.state == State::good ? good_value(map.points[reading.point], reading) : why_not(reading);
}

std::vector<std::string> table_lines(const Map& map, const Snapshot& now, Colour colour) {
  constexpr std::size_t widest = 32;  // a long text or array does not push all others aside
  std::vector<Cells> rows{{"point", "value", "type", "table", "address", "Modicon"}};
  for (const Reading& reading : now.readings) rows.push_back(cells_of(map, reading));
  std::array<std::size_t, std::tuple_size_v<Cells>> widths{};
  for (const Cells& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i)
      if (i == 0 || width(row[i]) <= widest) widths[i] = std::max(widths[i], width(row[i]));

  std::vector<std::string> lines{head(map, now)};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Reading* const reading = i == 0 ? nullptr : &now.readings[i - 1];
    const bool changed = reading != nullptr && reading->changed;
    std::string line;
    for (std::size_t cell = 0; cell < widths.size(); ++cell)
      line += padded(rows[i][cell], widths[cell]) + "  ";
    if (reading != nullptr && reading->state != State::good) line += printable(why_not(*reading));
    line.erase(line.find_last_not_of(' ') + 1);
    line.insert(0, changed ? "* " : "  ");
    lines.push_back(changed && colour == Colour::yes ? "\033[1m" + line + "\033[0m" : line);
  }
  for (const std::string& note : now.notes) add_lines(lines, note);
  return lines;
}

std::vector<std::string> change_lines(const Map& map, const Snapshot* before, const Snapshot& now) {
  std::vector<std::string> lines;
  const std::string time = utc_text(now.at);
  const auto add = [&](const std::string& text) {
    lines.push_back(fmt::format("{} {}", time, printable(text)));
  };
  if (now.error) {
    const std::string why = host::to_string(*now.error);
    if (before == nullptr || before->online() || host::to_string(*before->error) != why)
      add("offline: " + why);
    return lines;
  }
  const bool all = before == nullptr || !before->online();
  if (before != nullptr && !before->online()) add("online again");
  for (const Reading& reading : now.readings)
    if (all || reading.changed)
      add(fmt::format("{} {}", map.points[reading.point].name, value_text(map, reading)));
  return lines;
}

std::string frame(const std::vector<std::string>& lines, std::size_t rows) {
  const std::size_t room = rows > 2 ? rows - 1 : 1;  // below them the cursor has a row of its own
  const std::size_t shown = lines.size() <= room ? lines.size() : room - 1;
  std::string text = "\033[H";
  for (std::size_t i = 0; i < shown; ++i) text += lines[i] + "\033[K\n";
  if (shown < lines.size())
    text += fmt::format("… and {} lines more; choose points with --points\033[K\n", lines.size() - shown);
  return text + "\033[J";
}

}  // namespace coupler::tools
