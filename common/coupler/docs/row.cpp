// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/row.hpp"

#include <fmt/format.h>

#include "coupler/codec/text.hpp"
#include "coupler/docs/ros_message.hpp"
#include "coupler/docs/words.hpp"
#include "coupler/plan/explain.hpp"

namespace coupler::docs {
namespace {

using codec::Type;

std::string text_of(const Point& point) {
  if (point.format.type != Type::STRING) return {};
  return fmt::format("{} bytes, {}", point.format.length, codec::to_string(point.format.encoding));
}

std::string part_of(const Point& point) {
  if (!is_partial(point)) return {};
  if (point.format.type == Type::BOOL) return fmt::format("bit {}", point.format.bit);
  return point.format.half == codec::Half::high ? "high byte" : "low byte";
}

std::string order_of(const Point& point) {
  if (holds_bits(point.table)) return {};
  return std::string(codec::order_text(point.format));
}

std::string range_text(std::string first, std::string last) {
  return first == last ? first : std::move(first) + " – " + std::move(last);
}

void put_source(const Point& point, Row& row) {
  if (point.line.present()) {
    row.source = words(point.line);
    row.source_details = details(point.line);
  } else if (point.counter.present()) {
    row.source = "counter";
    row.source_details = words(point.counter);
  } else if (point.latched.present()) {
    row.source = "latch";
    row.source_details = words(point.latched);
  } else if (point.iio.present()) {
    row.source = fmt::format("{} {}", point.iio.device, point.iio.channel);
    row.source_details = "Industrial I/O";
  } else if (point.pwm.present()) {
    row.source = fmt::format("{} channel {}", point.pwm.chip, point.pwm.channel);
    row.source_details = "PWM, period " + words(point.pwm.period);
  }
}

/// Only outputs with hardware have a safe state.
std::string safe_of(const Point& point) {
  const bool coil = point.table == Table::coils;
  const bool has_hardware = coil ? point.line.present() : is_writable(point.table) && is_analogue(point);
  if (!has_hardware && point.safe == Safe::off) return {};  // nothing was said
  if (point.safe == Safe::hold) return "hold";
  if (!point.safe_value.empty()) return value_words(point, point.safe_value);
  if (coil) return point.safe == Safe::on ? "on" : "off";
  return "0";
}

}  // namespace

Row row_of(const Point& point, int line) {
  Row row;
  row.name = point.name;
  row.description = point.description;
  row.table = point.table;
  row.first = range(point).start();
  row.last = range(point).last();
  row.wire = range_text(fmt::to_string(row.first), fmt::to_string(row.last));
  row.modicon = range_text(plan::modicon(point.table, row.first), plan::modicon(point.table, row.last));
  row.part = part_of(point);
  if (point.read_address)
    row.read_at =
        fmt::format("{} ({})", *point.read_address, plan::modicon(point.table, *point.read_address));
  row.type = codec::to_string(point.format.type);
  row.text = text_of(point);
  row.order = order_of(point);
  if (point.count > 1) row.count = fmt::to_string(point.count);
  row.scale = words(point.scale);
  row.units = point.units;
  row.range = range_words(point);
  row.access = words(point.access);
  put_source(point, row);
  row.initial = value_words(point, point.initial);
  row.safe = safe_of(point);
  if (point.host.deadman.present()) {
    const std::string value = value_words(point, point.host.deadman.value);
    row.deadman = fmt::format("{} after {}", value, words(point.host.deadman.timeout));
  }
  if (point.host.rate > 0 && is_readable(point)) row.rate = fmt::format("{} Hz", point.host.rate);
  row.message = ros_message(point);
  row.line = line;
  return row;
}

}  // namespace coupler::docs
