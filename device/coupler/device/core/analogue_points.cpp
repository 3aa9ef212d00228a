// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/analogue_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "coupler/device/core/each_point.hpp"

namespace coupler::device {
namespace {

using modbus::Exception;
using modbus::Range;
using Outcome = Channels::Outcome;

template <class Use>
void each_channel(const Map& map, Table table, Range touched, Use use) {
  each_number(map, table, touched, [&](const Point& point) {
    if (is_analogue(point)) use(point);
  });
}

/// Returns the value in the point's registers; it is not finite if a REAL or LREAL is not.
double value_in(const Point& point, const std::uint16_t* registers) {
  return codec::published(registers, point.format, point.scale);
}

/// The same in `next`, which has one element for each address of the range.
double value_in(const Point& output, Range holding, Span<const std::uint16_t> next) {
  return value_in(output, &next[static_cast<std::size_t>(output.address - holding.start())]);
}

template <class Use>
void each_output(const Map& map, Use use) {
  for (const Point& point : map.points)
    if (point.table == Table::holding_registers && is_analogue(point)) use(point);
}

}  // namespace

double safe_value_of(const Point& output) {
  if (output.safe == Safe::on && !output.safe_value.empty())
    return value_in(output, output.safe_value.data());
  if (output.pwm.present()) return 0;
  constexpr std::array<std::uint16_t, widest_number> zero{};
  return value_in(output, zero.data());
}

bool AnaloguePoints::read(Range inputs, TimePoint now) {
  bool good = true;
  each_channel(map_, Table::input_registers, inputs, [&](const Point& point) {
    if (const auto value = channels_.read(point, now); value && std::isfinite(*value))
      codec::encode_nearest(*value, point.format, point.scale, image_.find(point.table, range(point)).data());
    else
      good = false;
  });
  return good;
}

bool AnaloguePoints::has_output(Range holding) const {
  bool any = false;
  each_channel(map_, Table::holding_registers, holding, [&](const Point&) { any = true; });
  return any;
}

bool AnaloguePoints::accepts(Range holding, Span<const std::uint16_t> next) const {
  bool all = true;
  each_channel(map_, Table::holding_registers, holding, [&](const Point& output) {
    const double value = value_in(output, holding, next);
    all &= std::isfinite(value) && channels_.accepts(output, value);
  });
  return all;
}

tl::expected<void, Exception> AnaloguePoints::check(Range holding, Span<const std::uint16_t> next) const {
  if (!accepts(holding, next)) return tl::unexpected(Exception::illegal_data_value);
  bool plugged = true;
  each_channel(map_, Table::holding_registers, holding,
               [&](const Point& output) { plugged &= channels_.is_plugged(output); });
  if (!plugged) return tl::unexpected(Exception::server_device_failure);
  return {};
}

tl::expected<void, Exception> AnaloguePoints::drive(Range holding, Span<const std::uint16_t> next) {
  if (!accepts(holding, next)) return tl::unexpected(Exception::illegal_data_value);
  std::optional<Exception> why;
  each_channel(map_, Table::holding_registers, holding, [&](const Point& output) {
    if (why) return;
    const Outcome outcome = channels_.drive(output, value_in(output, holding, next));
    if (outcome == Outcome::done) return;
    why = outcome == Outcome::refused ? Exception::illegal_data_value : Exception::server_device_failure;
    restore(holding, output);
  });
  if (why) return tl::unexpected(*why);
  return {};
}

bool AnaloguePoints::drive_each(Range holding, Span<std::uint16_t> next) {
  bool good = true;
  each_channel(map_, Table::holding_registers, holding, [&](const Point& output) {
    const double value = value_in(output, holding, next);
    const Outcome outcome = std::isfinite(value) ? channels_.drive(output, value) : Outcome::refused;
    if (outcome == Outcome::done || outcome == Outcome::absent) return;
    const auto now = image_.find(output.table, range(output));
    std::copy(now.begin(), now.end(), &next[static_cast<std::size_t>(output.address - holding.start())]);
    good = false;
  });
  return good;
}

void AnaloguePoints::restore(Range holding, const Point& end) {
  each_channel(map_, Table::holding_registers, holding, [&](const Point& output) {
    // The channel reports the result.
    if (&output < &end)
      (void)channels_.drive(output, value_in(output, image_.find(output.table, range(output)).data()));
  });
}

bool AnaloguePoints::drive(const Point& output, bool safe) {
  std::uint16_t* registers = image_.find(output.table, range(output)).data();
  const bool to_safe_value = safe && output.safe != Safe::hold;
  const double value = to_safe_value ? safe_value_of(output) : value_in(output, registers);
  if (!std::isfinite(value)) return false;
  const Outcome outcome = channels_.drive(output, value);
  // A device that is unplugged has to come back safe, whoever asks for it then.
  if (to_safe_value && (outcome == Outcome::done || outcome == Outcome::absent))
    codec::encode_nearest(value, output.format, output.scale, registers);
  return outcome == Outcome::done;
}

bool AnaloguePoints::drive_all(bool safe) {
  bool good = true;
  each_output(map_, [&](const Point& output) { good &= drive(output, safe); });
  return good;
}

bool AnaloguePoints::drive_safe() {
  bool good = true;
  each_output(map_, [&](const Point& output) {
    if (output.safe != Safe::hold) good &= drive(output, true);
  });
  return good;
}

}  // namespace coupler::device
