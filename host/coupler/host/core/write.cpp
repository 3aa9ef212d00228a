// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/write.hpp"

#include <algorithm>
#include <cassert>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "coupler/codec/number.hpp"
#include "coupler/host/core/error.hpp"

namespace coupler::host {
namespace {

using Outcome = WriteResult::Outcome;

std::string registers_text(Span<const std::uint16_t> registers) {
  return fmt::format("{:#06x}", fmt::join(registers.begin(), registers.end(), " "));
}

std::string exception_text(const WriteResult& result) {
  std::string text =
      to_string(Error(ExceptionReply{result.exception.value_or(static_cast<modbus::Exception>(0))}));
  if (!result.why.empty()) text += fmt::format(": {}", result.why);
  return text;
}

std::string not_taken_text(const WriteResult& result) {
  if (!result.exception && !result.why.empty()) return fmt::format("not taken: {}", result.why);
  if (result.found.empty())
    return fmt::format("not taken: acknowledged, but it cannot be read back: {}", exception_text(result));
  return fmt::format("not taken: acknowledged, but {} was written and {} reads back",
                     registers_text(result.written), registers_text(result.found));
}

std::optional<Write> safe_value(const Map& map, std::uint32_t index) {
  const Point& point = map.points[index];
  if (!is_writable(point) || point.safe == Safe::hold) return std::nullopt;
  if (point.table != Table::coils) {
    if (point.safe == Safe::on) return make_write(map, index, point.safe_value);
    return is_analogue(point) ? std::optional(make_write(map, index, {})) : std::nullopt;
  }
  Write write = make_write(map, index, point.safe_value);
  if (point.safe == Safe::on && point.safe_value.empty())
    for (std::size_t i = 0; i < point.count; ++i) write.set_bit(i);
  return write;
}

}  // namespace

std::string_view to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::ok: return "ok";
    case Outcome::superseded: return "superseded";
    case Outcome::exception: return "exception";
    case Outcome::not_taken: return "not taken";
    case Outcome::lost: return "lost";
    case Outcome::dropped: return "dropped";
    case Outcome::kept: return "kept";
    case Outcome::refused: return "refused";
  }
  return "?";
}

std::string to_string(const WriteResult& result) {
  switch (result.outcome) {
    case Outcome::exception: return exception_text(result);
    case Outcome::not_taken: return not_taken_text(result);
    case Outcome::kept: return "kept: it is written when the device is back";
    case Outcome::ok:
    case Outcome::superseded: return std::string(to_string(result.outcome));
    case Outcome::lost:
    case Outcome::dropped:
    case Outcome::refused: break;
  }
  return fmt::format("{}: {}", to_string(result.outcome), result.why);
}

Write make_write(const Map& map, std::uint32_t point, Span<const std::uint16_t> value) {
  Write write;
  write.point = point;
  if (map.points[point].table == Table::coils) {
    for (std::size_t i = 0; i < value.size(); ++i)
      if (value[i] != 0) write.set_bit(i);
  } else {
    assert(value.size() <= write.registers.size());
    std::copy(value.begin(), value.end(), write.registers.begin());
  }
  return write;
}

Write make_bit_write(const Map& map, std::uint32_t point, bool on) {
  const Point& bit = map.points[point];
  const std::uint16_t value =
      holds_bits(bit.table) ? std::uint16_t{on} : codec::encode_part(on ? 1 : 0, bit.format);
  return make_write(map, point, {&value, 1});
}

std::vector<Write> safe_values(const Map& map) {
  std::vector<Write> values;
  for (std::uint32_t i = 0; i < map.points.size(); ++i)
    if (const auto value = safe_value(map, i)) values.push_back(*value);
  // Both outputs of a tool must not be on.
  std::stable_partition(values.begin(), values.end(), [&](const Write& write) {
    return tool_with_output(map, map.points[write.point].name) != nullptr && write.registers[0] == 0;
  });
  return values;
}

}  // namespace coupler::host
