// SPDX-License-Identifier: Apache-2.0
// What a Handler does with requests that write: coils and their pulses, holding registers, the watchdog's
// reset.
#include "coupler/device/core/handler.hpp"

#include <algorithm>

#include "coupler/device/core/each_point.hpp"
#include "coupler/map/allowed_values.hpp"
#include "coupler/map/identity.hpp"

namespace coupler::device {

using modbus::Exception;
using modbus::Function;

tl::expected<void, Exception> Handler::store(Table table, modbus::Range range, Span<std::uint16_t> cells,
                                             TimePoint now) {
  auto stored = drive_and_store(table, range, cells, now);
  if (!stored) return stored;
  if (wrote_output_) watchdog_.arm(now);
  schedule_.cancel_overlapping(table, range, now);
  return stored;
}

tl::expected<void, Exception> Handler::drive_and_store(Table table, modbus::Range range,
                                                       Span<std::uint16_t> cells, TimePoint now,
                                                       bool wanted_by_firmware) {
  if (is_forbidden(table, range)) return tl::unexpected(Exception::illegal_data_value);
  const auto next = Span<std::uint16_t>(next_).first(cells.size());
  edge_points_.keep_latches(table, range, cells, next);
  if (watchdog_.is_locked() && hardware_.driven(table, range, next))
    return tl::unexpected(Exception::server_device_failure);
  const bool pulses = has_pulses_ && table == Table::coils;
  if (pulses) begin_pulses(range, now);
  if (const auto driven = hardware_.drive(table, range, next, wanted_by_firmware); !driven) {
    if (driven.error().hardware_failed) ++statistics_.hardware_errors;
    return tl::unexpected(driven.error().exception);
  }
  std::copy(next.begin(), next.end(), cells.begin());
  if (hardware_.driven(table, range, cells)) wrote_output_ = true;
  schedule_.driven(table, range, cells);
  const TimePoint done = later(now);
  if (pulses) follow_pulses(range, done);
  changes_.set_time(done);
  changes_.compare(table, range);
  return {};
}

/// While the watchdog keeps outputs safe, a firmware that repeats what it wants does not undo that.
void Handler::drive_wanted(TimePoint now) {
  for (const WantedOutput& wanted : hardware_.take_wanted_outputs()) {
    const Point& point = map_.points[wanted.point];
    const int level = wanted.level ? 1 : 0;
    const bool is_kept_safe = watchdog_.state() == OutputWatchdog::State::expired &&
                              (watchdog_.is_locked() || safe_level(point.safe, level) != level);
    const modbus::Range coil = range(point);
    next_[0] = static_cast<std::uint16_t>(level);
    if (is_kept_safe || !drive_and_store(point.table, coil, image_.find(point.table, coil), now, true))
      hardware_.not_driven(wanted, is_kept_safe);
    else
      schedule_.cancel_overlapping(point.table, coil, now);
  }
}

void Handler::begin_pulses(modbus::Range coils, TimePoint now) {
  for (const Point& point : touched_points(map_, Table::coils, coils))
    if (is_pulsed(point) && next_[point.address - coils.start()] != 0 &&
        image_.find(Table::coils, range(point))[0] == 0)
      schedule_.pulse(point.address, now + point.pulse);
}

void Handler::follow_pulses(modbus::Range coils, TimePoint now, std::chrono::milliseconds longest) {
  for (const Point& point : touched_points(map_, Table::coils, coils)) {
    if (!is_pulsed(point)) continue;
    if (image_.find(Table::coils, range(point))[0] == 0)
      schedule_.end_pulse(point.address);
    else
      schedule_.pulse(point.address, now + std::min(point.pulse, longest));
  }
}

void Handler::begin_pulses_that_are_missing() {
  const TimePoint now = later({});
  for (const Point& point : map_.points)
    if (is_pulsed(point) && image_.find(Table::coils, range(point))[0] != 0 &&
        !schedule_.has_pulse(point.address))
      schedule_.pulse(point.address, now + point.pulse);
}

Handler::Answer Handler::carry_out(const modbus::WriteBits& write, const Call& call) {
  const auto cells = image_.find_writable(Table::coils, write.range);
  if (cells.empty()) return tl::unexpected(Exception::illegal_data_address);
  if (!rights_of(call.session).may(Right::write, Table::coils, write.range)) return tl::unexpected(no_right);
  put_next(write);
  if (const auto stored = store(Table::coils, write.range, cells, call.now); !stored)
    return tl::unexpected(stored.error());
  return modbus::reply_written(call.request, call.reply);
}

Span<std::uint16_t> Handler::writable_registers(modbus::Range range) const {
  bool whole = true;
  each_number(map_, Table::holding_registers, range, [&](const Point& point) {
    if (point.counter.present() || is_analogue(point)) whole &= range.contains(coupler::range(point));
  });
  return whole ? image_.find_writable(Table::holding_registers, range) : Span<std::uint16_t>();
}

bool Handler::is_forbidden(Table table, modbus::Range written) const {
  if (!forbids_values_ || table != Table::holding_registers) return false;
  const auto points = touched_points(map_, table, written);
  return std::any_of(points.begin(), points.end(), [&](const Point& point) {
    return is_writable(point) && forbids_values(point) && is_forbidden(point, written);
  });
}

/// Value by value, so that an array needs no room for all of it.
bool Handler::is_forbidden(const Point& point, modbus::Range written) const {
  const std::uint16_t width = codec::registers(point.format);
  const auto now = image_.find(point.table, range(point));
  std::array<std::uint16_t, widest_number> value{};
  for (std::uint32_t at = 0; at < now.size(); at += width) {
    const auto own = modbus::Range::of(point.address + at, width);
    if (!own.overlaps(written)) continue;
    for (std::uint32_t i = 0; i < width; ++i) {
      const std::uint32_t address = own.start() + i;
      value[i] = written.contains(address) ? next_[address - written.start()] : now[at + i];
    }
    const bool concerned = !is_partial(point) || ((value[0] ^ now[at]) & codec::mask(point.format)) != 0;
    if (concerned && why_forbidden(point, value.data())) return true;
  }
  return false;
}

void Handler::put_next(const modbus::WriteBits& write) {
  for (std::size_t i = 0; i < write.range.count(); ++i) next_[i] = write.packed[i / 8] >> i % 8 & 1;
}

void Handler::put_next(const modbus::WriteRegisters& write) {
  for (std::size_t i = 0; i < write.range.count(); ++i) next_[i] = modbus::get_u16(&write.values[2 * i]);
}

/// Its line, its channel or its hook says that a point is an output.
bool Handler::may_reset_watchdog(const Rights& rights) {
  return std::all_of(map_.points.begin(), map_.points.end(), [&](const Point& point) {
    return rights.may(Right::write, point) || !is_writable(point) ||
           !hardware_.driven(point.table, range(point), image_.find(point.table, range(point)));
  });
}

Handler::Answer Handler::reset_watchdog(const modbus::WriteRegisters& write, const Call& call) {
  if (!may_reset_watchdog(rights_of(call.session))) return tl::unexpected(no_right);
  if (modbus::get_u16(write.values.data()) != identity::watchdog_reset_code)
    return tl::unexpected(Exception::illegal_data_value);
  watchdog_.reset();
  return modbus::reply_written(call.request, call.reply);
}

Handler::Answer Handler::carry_out(const modbus::WriteRegisters& write, const Call& call) {
  if (map_.service.watchdog.needs_reset() && write.range == identity::watchdog_reset)
    return reset_watchdog(write, call);
  const auto cells = writable_registers(write.range);
  if (cells.empty()) return tl::unexpected(Exception::illegal_data_address);
  if (!rights_of(call.session).may(Right::write, Table::holding_registers, write.range))
    return tl::unexpected(no_right);
  put_next(write);
  if (const auto stored = store(Table::holding_registers, write.range, cells, call.now); !stored)
    return tl::unexpected(stored.error());
  return modbus::reply_written(call.request, call.reply);
}

Handler::Answer Handler::carry_out(const modbus::MaskWrite& write, const Call& call) {
  const auto cells = writable_registers(write.range);
  if (cells.empty()) return tl::unexpected(Exception::illegal_data_address);
  const auto changed = static_cast<std::uint16_t>(~write.and_mask);
  if (!rights_of(call.session).may_write_bits(write.range.start(), changed)) return tl::unexpected(no_right);
  next_[0] = static_cast<std::uint16_t>((cells[0] & write.and_mask) | (write.or_mask & ~write.and_mask));
  if (const auto stored = store(Table::holding_registers, write.range, cells, call.now); !stored)
    return tl::unexpected(stored.error());
  return modbus::reply_written(call.request, call.reply);
}

Handler::Answer Handler::carry_out(const modbus::ReadWriteRegisters& both, const Call& call) {
  const auto read = image_.find_readable(Table::holding_registers, both.read);
  const auto written = writable_registers(both.write.range);
  if (read.empty() || written.empty()) return tl::unexpected(Exception::illegal_data_address);
  if (!rights_of(call.session).may(Right::read, Table::holding_registers, both.read) ||
      !rights_of(call.session).may(Right::write, Table::holding_registers, both.write.range))
    return tl::unexpected(no_right);
  if (const auto refused = hardware_.refuse_read(Table::holding_registers, both.read))
    return tl::unexpected(*refused);
  put_next(both.write);
  if (const auto stored = store(Table::holding_registers, both.write.range, written, call.now); !stored)
    return tl::unexpected(stored.error());
  return modbus::reply_registers(Function::read_write_multiple_registers, read, call.reply);
}

}  // namespace coupler::device
