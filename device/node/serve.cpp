// SPDX-License-Identifier: Apache-2.0
#include "device/node/serve.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "device/keeper/keeper.hpp"

namespace coupler::node {

int serve(const Map& map, const Options& options, StderrLog& log, const ReadAgain& read_again, Hooks* hooks) {
  const auto failed = [&](const Refusal& refusal) {
    tell(log, refusal);
    return refusal.reason;
  };
  Loop loop;
  if (!loop.is_open()) return failed({Refusal::device_failed, std::strerror(errno)});
  Signals signals(loop);
  log.never_wait();
  ServiceManager manager(std::getenv("NOTIFY_SOCKET"), std::getenv("WATCHDOG_USEC"));
  Station station(options, read_again, manager, log, hooks);
  if (const auto started = station.start(map); !started) return failed(started.error());
  Pulse* const managed = manager.is_there() ? &manager : nullptr;
  std::vector<OpenConnection> clients;
  const std::optional<bool> alone = station.serve_alone(loop, signals, clients);
  const bool safe = alone ? *alone : Keeper(loop, signals, station, log, managed).run(std::move(clients));
  manager.stopping();
  if (safe) return 0;
  return failed({Refusal::device_failed, "ended, and not every output could be driven to its safe state"});
}

}  // namespace coupler::node
