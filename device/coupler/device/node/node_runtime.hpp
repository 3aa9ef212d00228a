// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "coupler/device/analogue/sampler.hpp"
#include "coupler/device/node/guarded_hooks.hpp"
#include "coupler/device/node/io_service.hpp"
#include "coupler/device/node/loop_waker.hpp"
#include "coupler/device/node/map_reading.hpp"
#include "coupler/device/node/options.hpp"
#include "coupler/device/node/reload_requests.hpp"
#include "coupler/device/node/service_manager.hpp"
#include "coupler/device/node/serving_context.hpp"
#include "coupler/device/supervisor/supervisor.hpp"
#include "coupler/device/tls_process/tls_process.hpp"

namespace coupler::device {

/// A node with the map in force, which may be replaced by another one while clients are served.
class NodeRuntime final : public Workload {
 public:
  /// `loop` is the supervisor's. `again` is empty if the map is built in, `hooks` null if no code is bound to
  /// its points. All of them outlive it.
  NodeRuntime(Loop& loop, const Options& options, ReadMap again, ServiceManager& manager, Log& log,
              Hooks* hooks = nullptr);

  /// Puts the first map in force; it outlives the runtime. `settings`: as MapRead.
  tl::expected<void, ServeError> start(const Map& map, Descriptor settings);

  int serve(SupervisorLink& supervisor, std::vector<OpenConnection> clients) override;
  void reload(pid_t requester) override;
  bool look_after(TimePoint now) override;
  void change(std::vector<OpenConnection>& clients) override;
  std::size_t begin_safe() override;
  bool drive_safe(std::size_t part) override;
  bool went_safe(const std::vector<SafeOutcome>& parts) override;
  bool end_durations(const std::vector<SafeOutcome>& parts) override;
  bool make_firmware_safe() override;
  bool has_firmware() const override { return firmware_ != nullptr; }

  /// The worker process serves: the first time, the log says so.
  void beat() override;

 private:
  std::string status_line() const;
  void warn_of_open_outputs();
  void begin_reading(TimePoint now);
  bool take_map();
  tl::expected<void, ServeError> prepare_tls(Descriptor settings);
  bool tls_is_ready(TimePoint now);
  void refuse(const ServeError& error);
  bool reconnect(TimePoint now);
  void hurry() const;
  void end_durations_that_do_not_fit();
  int end_without_supervisor(IoService& service);
  std::string why_it_ends(int signal, pid_t supervisor) const;

  Loop& loop_;
  const Options& options_;
  ReadMap again_;
  ServiceManager& manager_;
  Log& log_;
  Hooks* firmware_;
  bool has_announced_ = false;
  std::unique_ptr<GuardedHooks> hooks_;  ///< null: there is no firmware
  std::unique_ptr<LoopWaker>
      waker_;  ///< in a process that serves; the firmware's threads may outlive serve()
  std::unique_ptr<ServingContext> context_;
  /// In a process that serves. It outlives serve(): who waited for a slow conversion would not end in time.
  std::unique_ptr<Sampler> sampler_;
  std::unique_ptr<ServingContext> next_;    ///< waits for change()
  std::unique_ptr<ServingContext> former_;  ///< waits to be freed
  std::unique_ptr<MapReading> reading_;     ///< null: no map is being read
  std::unique_ptr<TlsProcess> tls_;         ///< null: the map in force has no TLS
  std::unique_ptr<TlsProcess> next_tls_;    ///< of a map that is the first to have it
  bool awaits_tls_ = false;                 ///< its answer to what was read
  ReloadRequests requests_;
  TimePoint next_look_{};
};

}  // namespace coupler::device
