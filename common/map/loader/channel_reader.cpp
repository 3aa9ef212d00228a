// SPDX-License-Identifier: Apache-2.0
#include "common/map/loader/channel_reader.hpp"

#include <fmt/format.h>

#include "common/map/loader/value_reader.hpp"

namespace coupler::loader {
namespace {

/// The keys that a channel must have.
bool has_all(const Reader& point, const Reader& reader, const Entry& entry, Context& context) {
  const std::string_view key = reader.missing();
  if (key.empty()) return true;
  context.problems.error(entry.key_at, fmt::format("'{}' has no '{}'", entry.key, key),
                         fmt::format("write it as in '{}: {}'", entry.key, point.example(entry.key)));
  return false;
}

void check_name(const Reader& reader, std::string_view key, std::string_view name) {
  if (name.empty()) reader.wrong(key, "a name");
}

void read_iio(const Reader& point, DraftPoint& draft, Context& context) {
  const Entry* entry = point.find("iio");
  if (entry == nullptr) return;
  draft.line_at = entry->at;
  if (entry->kind != Entry::Kind::map) return point.wrong("iio", "a map of 'device' and 'channel'");
  const Reader reader(*entry, Section::iio, context);
  if (!has_all(point, reader, *entry, context)) return;
  Iio& iio = draft.point.iio;
  reader.text("device", iio.device);
  reader.text("channel", iio.channel);
  check_name(reader, "device", iio.device);
  check_name(reader, "channel", iio.channel);
}

void read_pwm(const Reader& point, DraftPoint& draft, Context& context) {
  const Entry* entry = point.find("pwm");
  if (entry == nullptr) return;
  draft.line_at = entry->at;
  if (entry->kind != Entry::Kind::map) return point.wrong("pwm", "a map of 'chip', 'channel' and 'period'");
  const Reader reader(*entry, Section::pwm, context);
  if (!has_all(point, reader, *entry, context)) return;
  Pwm& pwm = draft.point.pwm;
  reader.text("chip", pwm.chip);
  reader.integer("channel", pwm.channel);
  reader.duration("period", pwm.period);
  check_name(reader, "chip", pwm.chip);
}

void check_type(const Entry& channel, const Point& point, Context& context) {
  if (codec::is_scalable(point.format.type) && !codec::is_partial(point.format)) return;
  context.problems.error(channel.key_at,
                         fmt::format("'{}' does not apply to {}", channel.key, to_string(point.format.type)),
                         "use a type that is a number in registers of its own: INT to ULINT, REAL or LREAL");
}

void read_safe(const Reader& reader, DraftPoint& draft, Context& context) {
  const Entry* entry = reader.find("safe");
  if (entry == nullptr) return;
  Point& point = draft.point;
  const bool is_output = is_analogue(point);
  if (entry->kind == Entry::Kind::scalar && entry->text == "hold") {
    point.safe = Safe::hold;
  } else if (draft.placed && !(is_output && entry->kind == Entry::Kind::scalar && entry->text == "off")) {
    point.safe = Safe::on;
    point.safe_value = read_value("safe", *entry, point, context);
  }
}

}  // namespace

void read_channel(const Reader& reader, DraftPoint& draft, Context& context) {
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
  if (holding) read_safe(reader, draft, context);
}

}  // namespace coupler::loader
