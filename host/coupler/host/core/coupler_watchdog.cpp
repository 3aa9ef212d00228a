// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/coupler_watchdog.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace coupler::host {
namespace {

using Step = WatchdogSequences::Write;

std::string_view remedy(modbus::Exception code) {
  switch (code) {
    case modbus::Exception::server_device_busy: return "another client owns its outputs; end that client";
    case modbus::Exception::illegal_function:
    case modbus::Exception::illegal_data_address: return "check that 'preset' is right for this device";
    default:
      return "check that no other client keeps it running; docs/couplers.md says what each coupler needs";
  }
}

/// Makes one write (FC 5 or 6).
Result<std::optional<RejectedStep>> write_step(const Step& step, Link& link) {
  const auto request = step.table == Table::coils
                           ? modbus::WriteRequest::coil(step.address, step.value != 0)
                           : modbus::WriteRequest::register_value(step.address, step.value);
  Result<> done = link.send(request);
  if (done) done = link.receive();
  if (done) return std::nullopt;
  const ExceptionReply* exception = exception_in(done.error());
  if (exception == nullptr || is_unit_away(done.error())) return tl::make_unexpected(done.error());
  return RejectedStep{step, exception->code};
}

/// Until it is tried again to arm or reset it.
constexpr auto shortest_retry = std::chrono::milliseconds(1000);

}  // namespace

std::string to_string(const RejectedStep& rejected) {
  return fmt::format("writing {} to {} {}: {}; {}", rejected.step.value, to_string(rejected.step.table),
                     rejected.step.address, to_string(Error(ExceptionReply{rejected.code})),
                     remedy(rejected.code));
}

Result<std::optional<RejectedStep>> write_steps(Span<const Step> steps, const Map& map, Link& link) {
  for (const Step& step : steps) {
    const Result<bool> is_so = step.if_different ? has_value(step, map, link) : Result<bool>(false);
    if (!is_so) return tl::make_unexpected(is_so.error());
    if (*is_so) continue;
    if (auto done = write_step(step, link); !done || done->has_value()) return done;
  }
  return std::nullopt;
}

Result<bool> has_value(const Step& place, const Map& map, Link& link) {
  const auto range = modbus::Range::of(place.address, 1);
  std::uint16_t value = 0;
  const Result<> read = link.read_as_mapped(map, place.table, range, &value);
  if (read) return value == place.value;
  if (exception_in(read.error()) == nullptr || is_unit_away(read.error()))
    return tl::make_unexpected(read.error());
  return false;
}

CouplerWatchdog::CouplerWatchdog(const Map& map, Link& link, DeviceStatistics& statistics, Sink& sink)
    : map_(map),
      known_(map.coupler_watchdog),
      link_(link),
      clock_(link.clock()),
      statistics_(statistics),
      sink_(sink) {}

Result<> CouplerWatchdog::connected() {
  if (!known_.present()) return {};
  resets_.open();
  const auto done = bring_up(known_.recovery == Watchdog::Recovery::automatic);
  return done ? Result<>{} : tl::make_unexpected(done.error());
}

void CouplerWatchdog::disconnected(const std::string& why) {
  resets_.close(why);
  if (!known_.present() || status_.state == State::expired)
    return;  // expired: it still is, as far as we know
  status_.state = State::not_fed;
  status_.error_text.clear();
  statistics_.watchdog(status_);
}

Time CouplerWatchdog::due() const {
  if (!known_.present()) return Time::max();
  if (resets_.any()) return Time::min();
  if (status_.state != State::fed) return next_;
  if (known_.refusal && link_.has_seen(*known_.refusal)) return Time::min();
  if (known_.feed.empty() && !known_.alarm) return link_.last_answer() + known_.feed_every;
  return next_;
}

Result<bool> CouplerWatchdog::step() {
  if (!resets_.any()) return serve(known_.recovery == Watchdog::Recovery::automatic);
  const std::size_t asked = resets_.size();
  auto is_back = bring_up(true);
  if (!is_back) return is_back;  // disconnected() tells them
  const bool success = status_.state == State::fed;
  resets_.answer(asked, {success, !success   ? status_.error_text
                                  : *is_back ? "reset, and fed again"
                                             : "it had not expired"});
  return is_back;
}

Result<bool> CouplerWatchdog::serve(bool may_reset) {
  const bool suspicious =
      status_.state != State::fed || known_.alarm || (known_.refusal && link_.has_seen(*known_.refusal));
  if (suspicious) return bring_up(may_reset);
  const auto done = feed();
  return done ? Result<bool>(false) : tl::make_unexpected(done.error());
}

Result<bool> CouplerWatchdog::bring_up(bool may_reset) {
  auto first = is_expired();
  if (!first) return first;
  if (!*first && status_.state == State::fed) {
    next_ = clock_.now() + known_.feed_every;
    return false;
  }
  const bool was_expired = *first || status_.state == State::expired;
  if (*first) {
    expired();
    if (!may_reset) return false;
    if (auto done = carry_out(known_.reset); !done || !*done) return done;
    auto still = is_expired();
    if (!still) return still;
    if (*still) {
      report_failure(State::expired,
                     "the device's watchdog was reset, but writes to outputs are still refused: look for a "
                     "fault of its bus "
                     "or its modules");
      return false;
    }
  }
  if (auto done = carry_out(known_.arm); !done || !*done) return done;
  fed();
  return was_expired;
}

Result<> CouplerWatchdog::feed() {
  if (known_.feed.empty()) return link_.keep_alive(map_);
  next_ = clock_.now() + known_.feed_every;
  const auto rejected = write_step(known_.feed[turn_++ % known_.feed.size()], link_);
  if (!rejected) return tl::make_unexpected(rejected.error());
  if (rejected->has_value() && (*rejected)->code != known_.refusal)
    report_failure(State::not_fed, "the device's watchdog cannot be fed: " + to_string(**rejected));
  return {};
}

Result<bool> CouplerWatchdog::is_expired() {
  link_.forget_exceptions();
  if (known_.alarm) return has_value(*known_.alarm, map_, link_);
  if (!known_.refusal) return false;
  if (const auto asked = link_.keep_alive(map_); !asked) return tl::make_unexpected(asked.error());
  const bool rejected = link_.has_seen(*known_.refusal);
  link_.forget_exceptions();
  return rejected;
}

Result<bool> CouplerWatchdog::carry_out(Span<const WatchdogSequences::Write> steps) {
  const auto rejected = write_steps(steps, map_, link_);
  if (!rejected) return tl::make_unexpected(rejected.error());
  if (!rejected->has_value()) return true;
  link_.forget_exceptions();
  report_failure(status_.state == State::expired ? State::expired : State::not_fed,
                 "the device's watchdog cannot be armed: " + to_string(**rejected));
  return false;
}

void CouplerWatchdog::expired() {
  next_ = clock_.now() + std::max<Duration>(known_.timeout, shortest_retry);
  if (status_.state == State::expired) return;
  ++status_.expiries;
  const bool automatic = known_.recovery == Watchdog::Recovery::automatic;
  report_failure(
      State::expired,
      fmt::format(
          "the device's watchdog has expired: {} ms without a request from the driver; its outputs are "
          "off. {}",
          known_.timeout.count(),
          automatic ? "It is being reset"
                    : fmt::format("When the machine may go on, call {}/reset_watchdog", map_.name)));
}

void CouplerWatchdog::report_failure(State state, const std::string& what) {
  next_ = clock_.now() + std::max<Duration>(known_.timeout, shortest_retry);
  status_.state = state;
  if (std::exchange(status_.error_text, what) != what) sink_.on_report(Level::error, what);
  statistics_.watchdog(status_);
}

void CouplerWatchdog::fed() {
  next_ = clock_.now() + known_.feed_every;
  turn_ = 0;
  const bool was_expired = status_.state == State::expired;
  status_.state = State::fed;
  status_.error_text.clear();
  statistics_.watchdog(status_);
  if (was_expired && map_.on_reconnect == OnReconnect::drop)
    sink_.on_report(
        Level::warning,
        "the device's watchdog is reset and fed again; its outputs stay off until they are written "
        "('on_reconnect: restore' in the map would do that)");
  else
    sink_.on_report(Level::info,
                    fmt::format("the device's watchdog is {}fed: outputs go off after {} ms of silence",
                                was_expired ? "reset and " : "", known_.timeout.count()));
}

}  // namespace coupler::host
