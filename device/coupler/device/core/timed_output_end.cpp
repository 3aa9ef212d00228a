// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/timed_output_end.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "coupler/device/core/each_point.hpp"

namespace coupler::device {

using modbus::Range;
using Safety = ScheduledOutput::Safety;

namespace {

using Registers = std::array<std::uint16_t, widest_number>;

/// Returns the value of an output in its safe state, which is not Safe::hold.
Registers safe_state_of(const Point& output) {
  Registers value{};
  if (is_analogue(output))
    codec::encode_nearest(safe_value_of(output), output.format, output.scale, value.data());
  else
    value[0] = static_cast<std::uint16_t>(safe_level(output.safe, 0));
  return value;
}

}  // namespace

bool TimedOutputEnd::goes_back(const Point& point, const ScheduledOutput& which) const {
  if (point.latched.present() || point.counter.present()) return false;
  if (which.safety == Safety::unasked) return true;
  if (!has_hardware(point)) return is_pulsed(point) || !hardware_.has_code();
  return point.safe == Safe::hold || which.safety == Safety::failed;
}

/// Its part of the range; of a register that it shares only its own bits.
void TimedOutputEnd::put(const Point& point, ScheduledOutput& which) {
  const std::uint16_t mask = own_bits(point);
  const Range own = range(point);
  std::optional<Registers> safe;
  if (which.safety == Safety::failed && has_hardware(point) && point.safe != Safe::hold && !which.is_overdue)
    safe = safe_state_of(point);
  each_shared_address(own, which.range, [&](std::uint32_t at) {
    const std::size_t i = at - which.range.start();
    if (safe) which.set_value(i, (*safe)[at - own.start()]);  // what is tried again, unless it is written
    const std::uint16_t value = is_pulsed(point) ? std::uint16_t{0} : which.value(i);
    const auto back_in = [&](std::uint16_t now) {
      return static_cast<std::uint16_t>((now & ~mask) | (value & mask));
    };
    if (ScheduledOutput* later = schedule_.begun_after(which, at)) {
      const std::size_t its = at - later->range.start();
      later->set_value(its, back_in(later->value(its)));
    } else {
      next_[i] = back_in(next_[i]);
      back_[i] = true;
    }
  });
}

/// Neighbours in one step.
bool TimedOutputEnd::drive(const ScheduledOutput& which, Span<std::uint16_t> cells) {
  bool good = true;
  for (std::size_t first = 0; first < cells.size(); ++first) {
    if (!back_[first]) continue;
    std::size_t end = first;
    while (end < cells.size() && back_[end]) ++end;
    const auto next = next_.sub(first, end - first);
    const auto part = Range::of(static_cast<std::uint32_t>(which.range.start() + first),
                                static_cast<std::uint32_t>(end - first));
    good &= hardware_.drive_each(which.table, part, next);
    std::copy(next.begin(), next.end(), cells.sub(first, end - first).begin());
    first = end;
  }
  return good;
}

bool TimedOutputEnd::of(ScheduledOutput& which, TimePoint now) {
  const auto cells = image_.find(which.table, which.range);
  std::copy(cells.begin(), cells.end(), next_.begin());
  back_.reset();
  if (!cells.empty())
    for (const Point& point : touched_points(map_, which.table, which.range))
      if (goes_back(point, which)) put(point, which);
  const bool is_over = drive(which, cells);
  if (is_over)
    schedule_.remove(which);
  else
    schedule_.retry(which, now + retry_period);
  return is_over;
}

bool TimedOutputEnd::of_all(TimePoint now) {
  bool good = true;
  schedule_.each_begun([&](ScheduledOutput& which) { good &= of(which, now); });
  return good;
}

}  // namespace coupler::device
