// SPDX-License-Identifier: Apache-2.0
#include "device/node/serve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <deque>
#include <string>

#include "common/map/fingerprint.hpp"
#include "device/gpio/make_lines.hpp"
#include "device/net/signals.hpp"
#include "device/net/tcp_server.hpp"
#include "device/node/node.hpp"
#include "device/node/servable.hpp"

namespace coupler::node {
namespace {

enum Exit : int { stopped = 0, map_is_wrong = 1, device_failed = 3 };

class StderrLog : public Log {
 public:
  void write(std::string_view line) override { fmt::print(stderr, "coupler-node: {}\n", line); }
};

/// Logs each line of an error that may have several.
int fail(Log& log, Exit status, std::string_view errors) {
  while (!errors.empty()) {
    const auto end = std::min(errors.find('\n'), errors.size());
    log.write(fmt::format("error: {}", errors.substr(0, end)));
    errors.remove_prefix(std::min(end + 1, errors.size()));
  }
  return status;
}

/// Takes edges from the kernel as they come; a line that is gone is not watched any more.
class EdgeWatcher : public Watcher {
 public:
  EdgeWatcher(Loop& loop, EventSource& source, Log& log) : loop_(loop), source_(source) {
    if (!loop_.watch(source_.descriptor(), Interest::read, *this))
      log.write(fmt::format("an input's edges are seen late, when it is read: {}", std::strerror(errno)));
  }
  EdgeWatcher(const EdgeWatcher&) = delete;
  EdgeWatcher& operator=(const EdgeWatcher&) = delete;
  ~EdgeWatcher() { loop_.forget(source_.descriptor(), *this); }

  void ready(TimePoint) override {
    if (!source_.take_edges()) loop_.forget(source_.descriptor(), *this);
  }

 private:
  Loop& loop_;
  EventSource& source_;
};

using Patience = std::optional<std::chrono::milliseconds>;

/// nullopt is for ever.
Patience shorter(Patience a, Patience b) {
  if (!a || !b) return a ? a : b;
  return std::min(*a, *b);
}

std::string greeting(const Map& map, const Options& options, const TcpServer& tcp) {
  return fmt::format("serving {} ({} points, fingerprint {}) on {}{}", map.name, map.points.size(),
                     fingerprint_text(map.fingerprint), tcp.name(), options.simulated ? ", simulated" : "");
}

std::string farewell(int signal, bool safe, const Statistics& statistics) {
  return fmt::format(
      "{}: {}; answered {} requests, {} of them with an exception", ::strsignal(signal),
      safe ? "outputs are in their safe state" : "not every output could be driven to its safe state",
      statistics.requests, statistics.exceptions);
}

/// Serves until a signal asks to stop.
void run(Loop& loop, const Signals& signals, TcpServer& tcp, Node& node, Log& log) {
  std::uint32_t trips = 0;
  for (TimePoint now = TimePoint::clock::now(); signals.stop() == 0;) {
    now = loop.run_once(shorter(tcp.patience(), node.handler().patience(now)));
    tcp.tick(now);
    node.handler().tick(now);
    if (trips == node.statistics().watchdog_trips) continue;
    trips = node.statistics().watchdog_trips;
    log.write(
        "the watchdog expired: no master that writes was heard in time; outputs go to their safe state");
  }
}

}  // namespace

int serve(const Map& map, const Options& options) {
  StderrLog log;
  if (const auto servable = check_servable(map); !servable) return fail(log, map_is_wrong, servable.error());
  auto guests = guests_of(map);
  if (!guests) return fail(log, map_is_wrong, guests.error());

  Loop loop;
  if (!loop.is_open()) return fail(log, device_failed, std::strerror(errno));
  Signals signals(loop);
  // The network first: outputs are not touched by a program that then cannot serve them.
  auto listener = listen_on(address_for(map, options), options.port.value_or(map.connection.port));
  if (!listener) return fail(log, device_failed, listener.error());
  listener->guests = *std::move(guests);
  auto wiring = make_lines(map, options.simulated, log);
  if (!wiring) return fail(log, device_failed, wiring.error());
  std::deque<EdgeWatcher> watchers;
  for (EventSource* source : wiring->events) watchers.emplace_back(loop, *source, log);

  Node node(map, *wiring->lines, TimePoint::clock::now());
  TcpServer tcp(loop, *std::move(listener), node.server(), node.statistics(), log);
  log.write(greeting(map, options, tcp));
  run(loop, signals, tcp, node, log);

  const bool safe = wiring->lines->drive_safe();
  log.write(farewell(signals.stop(), safe, node.statistics()));
  return stopped;
}

}  // namespace coupler::node
