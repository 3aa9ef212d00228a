// SPDX-License-Identifier: Apache-2.0
#include "device/node/serve.hpp"

#include <fmt/format.h>

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

void log(std::string_view line) { fmt::print(stderr, "coupler-node: {}\n", line); }

/// Logs each line of an error that may have several.
int fail(Exit status, std::string_view errors) {
  while (!errors.empty()) {
    const auto end = std::min(errors.find('\n'), errors.size());
    log(fmt::format("error: {}", errors.substr(0, end)));
    errors.remove_prefix(std::min(end + 1, errors.size()));
  }
  return status;
}

/// Takes edges from the kernel as they come; a line that is gone is not watched any more.
class EdgeWatcher : public Watcher {
 public:
  EdgeWatcher(Loop& loop, EventSource& source) : loop_(loop), source_(source) {
    if (!loop_.watch(source_.descriptor(), Interest::read, *this))
      log("an input's edges cannot be watched: no memory");
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

std::string address_for(const Options& options) {
  if (!options.listen.empty() || !options.simulated) return options.listen;
  return "127.0.0.1";
}

std::string greeting(const Map& map, const Options& options, const TcpServer& tcp) {
  return fmt::format("serving {} ({} points, fingerprint {}) on {}{}", map.name, map.points.size(),
                     fingerprint_text(map.fingerprint), tcp.name(), options.simulated ? ", simulated" : "");
}

/// Outputs first: the farewell must not delay them.
void stop(Lines& lines, const Statistics& statistics, int signal) {
  const bool safe = lines.drive_safe();
  log(fmt::format(
      "{}: {}; answered {} requests, {} of them with an exception", ::strsignal(signal),
      safe ? "outputs are in their safe state" : "not every output could be driven to its safe state",
      statistics.requests, statistics.exceptions));
}

}  // namespace

int serve(const Map& map, const Options& options) {
  if (const auto servable = check_servable(map); !servable) return fail(map_is_wrong, servable.error());

  Loop loop;
  if (!loop.is_open()) return fail(device_failed, std::strerror(errno));
  Signals signals(loop);
  // The network first: outputs are not touched by a program that then cannot serve them.
  auto listener = listen_on(address_for(options), options.port.value_or(map.connection.port));
  if (!listener) return fail(device_failed, listener.error());
  auto wiring = make_lines(map, options.simulated, log);
  if (!wiring) return fail(device_failed, wiring.error());
  std::deque<EdgeWatcher> watchers;
  for (EventSource* source : wiring->events) watchers.emplace_back(loop, *source);

  Node node(map, *wiring->lines, TimePoint::clock::now());
  TcpServer tcp(loop, *std::move(listener), node.server(), node.statistics(), log);
  log(greeting(map, options, tcp));
  while (signals.stop() == 0) tcp.tick(loop.run_once(tcp.patience()));
  stop(*wiring->lines, node.statistics(), signals.stop());
  return stopped;
}

}  // namespace coupler::node
