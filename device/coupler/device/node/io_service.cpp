// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/io_service.hpp"

#include <algorithm>
#include <utility>

#include "coupler/base/line_limit.hpp"
#include "coupler/device/node/farewell.hpp"

namespace coupler::device {
namespace {

using Patience = std::optional<std::chrono::milliseconds>;

/// nullopt is for ever.
Patience shorter(Patience a, Patience b) {
  if (!a || !b) return a ? a : b;
  return std::min(*a, *b);
}

}  // namespace

IoService::IoService(const Duty& duty, Loop& loop, Log& log)
    : hardware_(duty.hardware()),
      loop_(loop),
      log_(log),
      statistics_(duty.memory->statistics()),
      node_(*duty.map, hardware_, *duty.memory),
      tcp_(loop, duty.listener, node_.server(), duty.memory->statistics(), log),
      now_(TimePoint::clock::now()),
      trips_(statistics_.watchdog_trips) {
  for (EventSource* source : duty.wiring->events()) watchers_.emplace_back(loop, *source, log);
}

void IoService::adopt(std::vector<OpenConnection> clients) { tcp_.adopt(std::move(clients), now_); }

void IoService::run(const std::function<bool(TimePoint)>& is_over, Pulse& pulse) {
  for (TimePoint next_beat = now_; !is_over(now_); turn()) {
    if (now_ < next_beat) continue;
    pulse.beat();
    next_beat = now_ + Pulse::period;
  }
  (void)log_.tick(now_ + LineLimit::interval);  // nobody says later what is still held back
}

std::vector<OpenConnection> IoService::release() { return tcp_.release(); }

void IoService::end(int signal) {
  log_.write(farewell(signal, make_safe(), statistics_, TimePoint::clock::now()));
}

void IoService::turn() {
  const Patience work = shorter(tcp_.patience(), node_.handler().patience(now_));
  now_ = loop_.run_once(shorter(Pulse::period, shorter(work, log_.tick(now_))));
  tcp_.tick(now_);
  node_.handler().tick(now_);
  log_trips();
}

void IoService::log_trips() {
  if (trips_ == statistics_.watchdog_trips) return;
  trips_ = statistics_.watchdog_trips;
  log_.warn_limited(
      "watchdog",
      "the watchdog expired: no master that writes was heard in time; outputs go to their safe state");
}

}  // namespace coupler::device
