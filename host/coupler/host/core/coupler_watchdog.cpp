// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/coupler_watchdog.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/core/probe.hpp"
#include "coupler/host/core/watchdog_writes.hpp"

namespace coupler::host {
namespace {

/// Whatever it is that keeps it from being armed or reset: it is tried again.
constexpr auto shortest_retry = std::chrono::milliseconds(1000);

}  // namespace

CouplerWatchdog::CouplerWatchdog(const Map& map, PacedTransport& transport, Clock& clock,
                                 DeviceStatistics& statistics, Sink& sink)
    : map_(map),
      known_(map.coupler_watchdog),
      transport_(transport),
      clock_(clock),
      statistics_(statistics),
      sink_(sink) {}

Result<> CouplerWatchdog::connected() {
  connected_ = known_.present();
  if (!connected_) return {};
  resets_.open();
  const auto done = bring_up(known_.recovery == Watchdog::Recovery::automatic);
  return done ? Result<>{} : tl::make_unexpected(done.error());
}

void CouplerWatchdog::disconnected(const std::string& why) {
  resets_.close(why);
  if (!std::exchange(connected_, false)) return;
  if (status_.state == State::expired) return;  // it still is, as far as we know
  status_.state = State::not_fed;
  status_.trouble.clear();
  statistics_.watchdog(status_);
}

Time CouplerWatchdog::due() const {
  if (!connected_) return Time::max();
  if (resets_.any()) return Time::min();
  if (status_.state != State::fed) return next_;
  if (known_.refusal && transport_.has_seen(*known_.refusal)) return Time::min();
  if (known_.feed.empty() && !known_.alarm) return transport_.last_answer() + known_.feed_every;
  return next_;
}

Result<bool> CouplerWatchdog::step() {
  if (!resets_.any()) return serve(known_.recovery == Watchdog::Recovery::automatic);
  auto is_back = bring_up(true);
  if (!is_back) return is_back;  // disconnected() tells them
  const bool success = status_.state == State::fed;
  resets_.answer({success, !success   ? status_.trouble
                           : *is_back ? "reset, and fed again"
                                      : "it had not expired"});
  return is_back;
}

Result<bool> CouplerWatchdog::serve(bool may_reset) {
  const bool suspicious =
      status_.state != State::fed || known_.alarm || (known_.refusal && transport_.has_seen(*known_.refusal));
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
      trouble(
          State::expired,
          "the coupler's watchdog is reset, and still outputs are refused: look for a fault of its bus or "
          "modules");
      return false;
    }
  }
  if (auto done = carry_out(known_.arm); !done || !*done) return done;
  fed();
  return was_expired;
}

Result<> CouplerWatchdog::feed() {
  if (known_.feed.empty()) return probe(map_, transport_);
  next_ = clock_.now() + known_.feed_every;
  const auto refused = write_step(known_.feed[turn_++ % known_.feed.size()], transport_);
  if (!refused) return tl::make_unexpected(refused.error());
  if (refused->has_value() && (*refused)->code != known_.refusal)
    trouble(State::not_fed, "the coupler's watchdog cannot be fed: " + to_string(**refused));
  return {};
}

Result<bool> CouplerWatchdog::is_expired() {
  transport_.forget_exceptions();
  if (known_.alarm) return has_value(*known_.alarm, transport_);
  if (!known_.refusal) return false;
  if (const auto asked = probe(map_, transport_); !asked) return tl::make_unexpected(asked.error());
  const bool refused = transport_.has_seen(*known_.refusal);
  transport_.forget_exceptions();
  return refused;
}

Result<bool> CouplerWatchdog::carry_out(Span<const WatchdogSequences::Write> steps) {
  const auto refused = write_steps(steps, transport_);
  if (!refused) return tl::make_unexpected(refused.error());
  if (!refused->has_value()) return true;
  transport_.forget_exceptions();
  trouble(status_.state == State::expired ? State::expired : State::not_fed,
          "the coupler's watchdog cannot be armed: " + to_string(**refused));
  return false;
}

void CouplerWatchdog::expired() {
  next_ = clock_.now() + std::max<Duration>(known_.timeout, shortest_retry);
  if (status_.state == State::expired) return;
  ++status_.expiries;
  const bool automatic = known_.recovery == Watchdog::Recovery::automatic;
  trouble(State::expired,
          fmt::format(
              "the coupler's watchdog has expired: {} ms without a request of the driver; its outputs are "
              "off. {}",
              known_.timeout.count(),
              automatic ? "It is reset now"
                        : fmt::format("When the machine may go on, call {}/reset_watchdog", map_.name)));
}

void CouplerWatchdog::trouble(State state, const std::string& what) {
  next_ = clock_.now() + std::max<Duration>(known_.timeout, shortest_retry);
  status_.state = state;
  if (std::exchange(status_.trouble, what) != what) sink_.on_report(Level::error, what);
  statistics_.watchdog(status_);
}

void CouplerWatchdog::fed() {
  next_ = clock_.now() + known_.feed_every;
  turn_ = 0;
  const bool was_expired = status_.state == State::expired;
  status_.state = State::fed;
  status_.trouble.clear();
  statistics_.watchdog(status_);
  if (was_expired && map_.on_reconnect == OnReconnect::drop)
    sink_.on_report(
        Level::warning,
        "the coupler's watchdog is reset and fed again; its outputs stay off until they are written "
        "('on_reconnect: restore' would do that)");
  else
    sink_.on_report(Level::info,
                    fmt::format("the coupler's watchdog is {}fed: outputs go off after {} ms of silence",
                                was_expired ? "reset and " : "", known_.timeout.count()));
}

}  // namespace coupler::host
