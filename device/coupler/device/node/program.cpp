// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/program.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <variant>

#include "coupler/base/standard_files.hpp"
#include "coupler/device/log/stderr_log.hpp"
#include "coupler/device/node/node_runtime.hpp"
#include "coupler/device/node/options.hpp"
#include "coupler/device/node/realtime.hpp"
#include "coupler/device/supervisor/supervisor.hpp"

namespace coupler::device {

namespace {

int run(const Map& map, Hooks* hooks, int argc, char** argv) {
  open_standard_files();
  const auto options = parse_options(argc, argv, MapSource::built_in);
  if (const int* status = std::get_if<int>(&options)) return *status;
  StderrLog log(std::getenv("JOURNAL_STREAM"));
  if (!map.security.files.present()) return serve(map, {}, std::get<Options>(options), log, {}, hooks);
  const ReadMap files{{}, log.descriptor(), &map};
  auto read = read_first(files);
  if (!read) {
    log_errors(log, read.error());
    return read.error().reason;
  }
  return serve(map, std::move(read->settings), std::get<Options>(options), log, files, hooks);
}

}  // namespace

int main_with(const Map& map, int argc, char** argv) { return run(map, nullptr, argc, argv); }

int main_with(const Map& map, Hooks& hooks, int argc, char** argv) { return run(map, &hooks, argc, argv); }

int serve(const Map& map, Descriptor settings, const Options& options, StderrLog& log, const ReadMap& again,
          Hooks* hooks) {
  const auto failed = [&](const ServeError& error) {
    log_errors(log, error);
    return error.reason;
  };
  if (options.realtime)
    if (const auto had = become_realtime(RealtimePriority::supervisor); !had)
      return failed({ServeError::device_failed, had.error()});
  Loop loop;
  if (!loop.is_open()) return failed({ServeError::device_failed, std::strerror(errno)});
  Signals signals(loop);
  log.never_wait();
  ServiceManager manager(std::getenv("NOTIFY_SOCKET"), std::getenv("WATCHDOG_USEC"));
  NodeRuntime runtime(loop, options, again, manager, log, hooks);
  if (const auto started = runtime.start(map, std::move(settings)); !started) return failed(started.error());
  const bool safe = Supervisor(loop, signals, runtime, log).run();
  manager.stopping();
  if (safe) return 0;
  return failed(
      {ServeError::device_failed, "not every output could be driven to its safe state when the node ended"});
}

}  // namespace coupler::device
