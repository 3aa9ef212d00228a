// SPDX-License-Identifier: Apache-2.0
#include "device/node/serve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

#include "common/map/fingerprint.hpp"
#include "device/gpio/make_lines.hpp"
#include "device/keeper/keeper.hpp"
#include "device/net/listener.hpp"
#include "device/net/signals.hpp"
#include "device/node/io_service.hpp"
#include "device/node/servable.hpp"
#include "device/node/service_manager.hpp"

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

std::string greeting(const Map& map, const Options& options, const Listener& listener) {
  return fmt::format("serving {} ({} point{}, fingerprint {}) on {}{}", map.name, map.points.size(),
                     map.points.size() == 1 ? "" : "s", fingerprint_text(map.fingerprint), listener.name,
                     options.simulated ? ", simulated" : "");
}

/// Simulated lines fall nowhere when nobody holds them.
bool needs_keeper(const Map& map, const Options& options) {
  const auto is_wired = [](const Point& point) { return point.line.present(); };
  return !options.simulated && std::any_of(map.points.begin(), map.points.end(), is_wired);
}

}  // namespace

int serve(const Map& map, const Options& options) {
  StderrLog log;
  if (const auto servable = check_servable(map); !servable) return fail(log, map_is_wrong, servable.error());
  auto guests = guests_of(map);
  if (!guests) return fail(log, map_is_wrong, guests.error());

  Loop loop;
  if (!loop.is_open()) return fail(log, device_failed, std::strerror(errno));
  const Signals signals(loop);
  // The network first: outputs are not touched by a program that then cannot serve them.
  auto listener = listen_on(address_for(map, options), options.port.value_or(map.connection.port));
  if (!listener) return fail(log, device_failed, listener.error());
  listener->guests = *std::move(guests);
  auto wiring = make_lines(map, options.simulated, log);
  if (!wiring) return fail(log, device_failed, wiring.error());
  Memory memory(map, TimePoint::clock::now());
  const std::string news = greeting(map, options, *listener);
  log.write(news);
  ServiceManager manager(std::getenv("NOTIFY_SOCKET"), std::getenv("WATCHDOG_USEC"), news);
  Pulse* const managed = manager.is_there() ? &manager : nullptr;

  if (!needs_keeper(map, options)) {
    IoService(map, *wiring, memory, *std::move(listener), loop, log).run(signals, managed);
    manager.stopping();
    return stopped;
  }
  const auto io_process = [&](Pulse& pulse) -> int {
    Loop own_loop;
    if (!own_loop.is_open()) return fail(log, device_failed, std::strerror(errno));
    const Signals own_signals(own_loop);
    // Outputs are in their safe state, however the process before this one ended.
    memory.watchdog().disarm();
    IoService(map, *wiring, memory, *std::move(listener), own_loop, log).run(own_signals, &pulse);
    return stopped;
  };
  Keeper(loop, signals, *wiring->lines, log, managed).run(io_process);
  manager.stopping();
  return stopped;
}

}  // namespace coupler::node
