// SPDX-License-Identifier: Apache-2.0
#include "device/node/serve.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "device/keeper/keeper.hpp"
#include "device/node/stderr_log.hpp"

namespace coupler::node {

int serve(const Map& map, const Options& options, const ReadAgain& read_again, Hooks* hooks) {
  StderrLog log(std::getenv("JOURNAL_STREAM"));
  const auto refused = [&](const Refusal& refusal) {
    tell(log, refusal);
    return refusal.reason;
  };
  Loop loop;
  if (!loop.is_open()) return refused({Refusal::device_failed, std::strerror(errno)});
  Signals signals(loop);
  ServiceManager manager(std::getenv("NOTIFY_SOCKET"), std::getenv("WATCHDOG_USEC"));
  Station station(options, read_again, manager, log, hooks);
  if (const auto started = station.start(map); !started) return refused(started.error());
  if (station.serve_alone(loop, signals))
    Keeper(loop, signals, station, log, manager.is_there() ? &manager : nullptr).run();
  manager.stopping();
  return 0;
}

}  // namespace coupler::node
