// SPDX-License-Identifier: Apache-2.0
// What a Handler does for clients that wait for changes.
#include "coupler/device/core/handler.hpp"

namespace coupler::device {

using modbus::Exception;

void Handler::tell_changes(std::uint32_t epoch, TimePoint now) {
  take(now);
  // Changes are told from the levels that the inputs have now. One that cannot be read says so in the log.
  for (const Image::Area& area : image_.mapped(Table::discrete_inputs)) {
    const auto range = modbus::Range::of(area.start, area.end - area.start);
    (void)hardware_.read(Table::discrete_inputs, range, image_.find(Table::discrete_inputs, range), now);
  }
  changes_.begin(epoch);
  set_machine(machine_);
}

void Handler::take_news(TimePoint now) {
  take(now);
  took_news_ = true;
}

void Handler::take(TimePoint now) {
  changes_.set_time(now);
  hardware_.take_news(now, edge_points_, changes_);
}

/// A client that has asked for changes not long ago will again: none waits for longer than half of that.
bool Handler::wants_news(TimePoint now) const {
  if (listened_ && now - *listened_ < 2 * std::chrono::milliseconds(modbus::longest_wait)) return true;
  return hears_lines_ || hardware_.has_to_look();
}

/// Brings the cells up to date. An input that has changed since news were taken is told of as well: no reply
/// shows a level that no change brings.
bool Handler::read_hardware(Table table, modbus::Range range, Span<std::uint16_t> cells, TimePoint now) {
  const bool is_read = hardware_.read(table, range, cells, now);
  if (table == Table::discrete_inputs && changes_.differs(table, range)) {
    take(now);
    changes_.compare(table, range);
  }
  return is_read;
}

Handler::Answer Handler::carry_out(const modbus::ChangesRequest& request, const Call& call) {
  if (!changes_.are_told()) return tl::unexpected(Exception::illegal_function);
  listened_ = call.now;
  call.session.wait = Wait{request, call.now, call.now + std::chrono::milliseconds(request.wait), 0, 0};
  return std::size_t{0};
}

}  // namespace coupler::device
