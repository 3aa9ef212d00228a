// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/point_description.hpp"

#include <fmt/format.h>

#include "coupler/codec/text.hpp"
#include "coupler/docs/words.hpp"
#include "coupler/map/typed_value.hpp"
#include "coupler/plan/explain.hpp"

namespace coupler::docs {
namespace {

using codec::Type;

std::string text_of(const Point& point) {
  if (point.format.type != Type::STRING) return {};
  return fmt::format("{} bytes, {}", point.format.length, codec::to_string(point.format.encoding));
}

std::string order_of(const Point& point) {
  if (holds_bits(point.table)) return {};
  return std::string(codec::order_text(point.format));
}

std::string range_text(std::string first, std::string last) {
  return first == last ? first : std::move(first) + " – " + std::move(last);
}

void put_source(const Point& point, PointDescription& out) {
  if (point.line.present()) {
    out.source = words(point.line);
    out.source_details = details(point.line);
  } else if (point.counter.present()) {
    out.source = "counter";
    out.source_details = words(point.counter);
  } else if (point.latched.present()) {
    out.source = "latch";
    out.source_details = words(point.latched);
  } else if (point.iio.present()) {
    out.source = fmt::format("{} {}", point.iio.device, point.iio.channel);
    out.source_details = "Industrial I/O";
  } else if (point.pwm.present()) {
    out.source = fmt::format("{} channel {}", point.pwm.chip, point.pwm.channel);
    out.source_details = "PWM, period " + words(point.pwm.period);
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

PointDescription describe(const Point& point, int line) {
  PointDescription out;
  out.name = point.name;
  out.description = point.description;
  out.table = point.table;
  out.first = range(point).start();
  out.last = range(point).last();
  out.address = range_text(fmt::to_string(out.first), fmt::to_string(out.last));
  out.modicon = range_text(plan::modicon(point.table, out.first), plan::modicon(point.table, out.last));
  out.part = part_text(point);
  if (point.read_address)
    out.read_at =
        fmt::format("{} ({})", *point.read_address, plan::modicon(point.table, *point.read_address));
  out.type = codec::to_string(point.format.type);
  out.text = text_of(point);
  out.order = order_of(point);
  if (point.count > 1) out.count = fmt::to_string(point.count);
  out.scale = words(point.scale);
  out.invalid = words(point.invalid);
  out.faults = words(point.faults);
  out.units = point.units;
  out.range = range_words(point);
  out.access = words(point.access);
  put_source(point, out);
  out.initial = value_words(point, point.initial);
  out.safe = safe_of(point);
  if (is_pulsed(point)) out.pulse = words(point.pulse);
  if (point.host.deadman.present()) {
    const std::string value = value_words(point, point.host.deadman.value);
    out.deadman = fmt::format("{} after {}", value, words(point.host.deadman.timeout));
  }
  if (point.host.priority != HostOptions::Priority::normal) out.priority = to_string(point.host.priority);
  if (point.host.rate > 0 && is_readable(point)) out.rate = fmt::format("{} Hz", point.host.rate);
  out.message = ros_message(point);
  out.line = line;
  return out;
}

}  // namespace coupler::docs
