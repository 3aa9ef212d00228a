// SPDX-License-Identifier: Apache-2.0
#include "device/node/io_service.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

namespace coupler::node {
namespace {

using Patience = std::optional<std::chrono::milliseconds>;

/// nullopt is for ever.
Patience shorter(Patience a, Patience b) {
  if (!a || !b) return a ? a : b;
  return std::min(*a, *b);
}

std::string farewell(int signal, bool safe, const Statistics& statistics) {
  return fmt::format(
      "{}: {}; answered {} requests, {} of them with an exception", ::strsignal(signal),
      safe ? "outputs are in their safe state" : "not every output could be driven to its safe state",
      statistics.requests, statistics.exceptions);
}

}  // namespace

IoService::IoService(const Map& map, Wiring& wiring, Memory& memory, Listener listener, Loop& loop, Log& log)
    : lines_(*wiring.lines),
      loop_(loop),
      log_(log),
      statistics_(memory.statistics()),
      node_(map, lines_, memory),
      tcp_(loop, std::move(listener), node_.server(), memory.statistics(), log),
      now_(TimePoint::clock::now()),
      trips_(statistics_.watchdog_trips) {
  for (EventSource* source : wiring.events) watchers_.emplace_back(loop, *source, log);
}

void IoService::run(const Signals& signals, Pulse* pulse) {
  for (TimePoint next_beat = now_; signals.stop() == 0;) {
    if (pulse != nullptr && now_ >= next_beat) {
      pulse->beat();
      next_beat = now_ + Pulse::period;
    }
    turn(pulse != nullptr ? Patience(Pulse::period) : std::nullopt);
  }
  log_.write(farewell(signals.stop(), lines_.drive_safe(), statistics_));
}

void IoService::turn(Patience at_most) {
  now_ = loop_.run_once(shorter(at_most, shorter(tcp_.patience(), node_.handler().patience(now_))));
  tcp_.tick(now_);
  node_.handler().tick(now_);
  log_trips();
}

void IoService::log_trips() {
  if (trips_ == statistics_.watchdog_trips) return;
  trips_ = statistics_.watchdog_trips;
  log_.write("the watchdog expired: no master that writes was heard in time; outputs go to their safe state");
}

}  // namespace coupler::node
