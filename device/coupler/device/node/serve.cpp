// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/serve.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "coupler/device/node/realtime.hpp"
#include "coupler/device/supervisor/supervisor.hpp"

namespace coupler::device {

int serve(const Map& map, const Options& options, StderrLog& log, const ReadMap& again, Hooks* hooks) {
  const auto failed = [&](const Refusal& refusal) {
    tell(log, refusal);
    return refusal.reason;
  };
  if (options.realtime)
    if (const auto had = become_realtime(RealtimePriority::supervisor); !had)
      return failed({Refusal::device_failed, had.error()});
  Loop loop;
  if (!loop.is_open()) return failed({Refusal::device_failed, std::strerror(errno)});
  Signals signals(loop);
  log.never_wait();
  ServiceManager manager(std::getenv("NOTIFY_SOCKET"), std::getenv("WATCHDOG_USEC"));
  NodeRuntime runtime(loop, options, again, manager, log, hooks);
  if (const auto started = runtime.start(map); !started) return failed(started.error());
  const bool safe = Supervisor(loop, signals, runtime, log, &runtime).run();
  manager.stopping();
  if (safe) return 0;
  return failed({Refusal::device_failed, "ended, and not every output could be driven to its safe state"});
}

}  // namespace coupler::device
