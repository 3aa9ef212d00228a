// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/io_service.hpp"

#include <algorithm>
#include <utility>

#include "coupler/base/line_limit.hpp"
#include "coupler/device/node/shutdown_summary.hpp"

namespace coupler::device {
namespace {

using TimeUntilDue = std::optional<std::chrono::milliseconds>;

/// nullopt is for ever.
TimeUntilDue shorter(TimeUntilDue a, TimeUntilDue b) {
  if (!a || !b) return a ? a : b;
  return std::min(*a, *b);
}

}  // namespace

IoService::IoService(const ServingContext& context, Loop& loop, Log& log)
    : hardware_(context.hardware()),
      loop_(loop),
      log_(log),
      statistics_(context.state->statistics()),
      node_(*context.map, hardware_, *context.state),
      tcp_(loop, context.listener, node_.server(), context.state->statistics(), log),
      now_(TimePoint::clock::now()),
      trips_(statistics_.watchdog_trips) {
  for (EventSource* source : context.wiring->events()) watchers_.emplace_back(loop, *source, log);
}

void IoService::take_over(std::vector<OpenConnection> clients) { tcp_.take_over(std::move(clients), now_); }

void IoService::run(const std::function<bool(TimePoint)>& is_over, Heartbeat& heartbeat) {
  for (TimePoint next_beat = now_; !is_over(now_); turn()) {
    if (now_ < next_beat) continue;
    heartbeat.beat();
    next_beat = now_ + Heartbeat::period;
  }
  (void)log_.tick(now_ + LineLimit::interval);  // nobody says later what is still held back
}

std::vector<OpenConnection> IoService::release() { return tcp_.release(); }

void IoService::end(int signal) {
  log_.write(shutdown_summary(signal, make_safe(), statistics_, TimePoint::clock::now()));
}

void IoService::turn() {
  const TimeUntilDue work = shorter(tcp_.time_until_due(), node_.handler().time_until_due(now_));
  now_ = loop_.run_once(shorter(Heartbeat::period, shorter(work, log_.tick(now_))));
  tcp_.tick(now_);
  node_.handler().tick(now_);
  log_trips();
}

void IoService::log_trips() {
  if (trips_ == statistics_.watchdog_trips) return;
  trips_ = statistics_.watchdog_trips;
  log_.warn_limited(
      "watchdog",
      "the watchdog expired: no client that writes was heard in time; outputs go to their safe state");
}

}  // namespace coupler::device
