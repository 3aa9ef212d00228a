// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "coupler/device/core/log.hpp"
#include "coupler/device/net/loop.hpp"
#include "coupler/device/net/message.hpp"
#include "coupler/device/supervisor/child.hpp"
#include "coupler/device/supervisor/cpu_time.hpp"
#include "coupler/device/supervisor/heartbeat.hpp"
#include "coupler/device/supervisor/supervisor.hpp"

namespace coupler::device {

/// The process that does TLS for a node, seen from the supervisor. It has the key, and no lines; it hands
/// each client that it lets in to the process that answers (net/open_connection.hpp), over a channel that
/// outlives both. If it dies or hangs its clients lose their connections, and it is started again.
class TlsProcess final : public EventHandler {
 public:
  /// The time limit for an answer; the process reads no files. It may be silent for as long. Time for which
  /// it waits for the CPU does not count.
  static constexpr std::chrono::seconds timeout{5};

  /// Both outlive it. The error says why it cannot be: no program, no descriptors.
  static tl::expected<std::unique_ptr<TlsProcess>, std::string> start(Loop& loop, Log& log);
  TlsProcess(const TlsProcess&) = delete;
  TlsProcess& operator=(const TlsProcess&) = delete;
  ~TlsProcess();

  /// Has it look at settings, which are not in force by that.
  void prepare(Descriptor settings);
  struct Answer {
    std::string problem;      ///< empty: the settings are good
    bool has_failed = false;  ///< the process itself; the settings may be good
  };
  /// Returns the result; nullopt if there is none yet.
  std::optional<Answer> answer(TimePoint now);
  /// The prepared settings are in force: the process listens at a copy of that socket.
  void commit(int listener);

  /// Starts it again if it has ended, or says nothing any more. To be called every 100 ms or so.
  void look_after(TimePoint now);

  /// The socket from which the process that answers takes clients.
  int clients() const { return clients_.one.get(); }
  /// In a process that was forked and answers clients: closes everything else.
  void leave();
  pid_t pid() const { return child_ ? child_->pid() : 0; }

  void ready(TimePoint now) override;

 private:
  TlsProcess(Loop& loop, Log& log, std::string program, Channel clients);
  int start_process(TimePoint now);
  std::string how_it_ended(std::chrono::milliseconds at_most);
  void end_process();
  bool is_silent(TimePoint now);
  void give_up(Answer answer);
  void send(std::uint8_t what, int descriptor);

  Loop& loop_;
  Log& log_;
  std::string program_;
  Channel clients_;  ///< one: for the process that answers, other: for the one that does TLS
  Descriptor control_;
  std::optional<Child> child_;
  std::optional<CpuWait> cpu_wait_;  ///< of the child
  std::optional<Silence> silence_;   ///< of the child
  bool heard_ = false;               ///< since it was sampled
  TimePoint ask_at_{};
  Descriptor settings_;  ///< in force
  Descriptor listener_;
  Descriptor prepared_;
  bool waits_ = false;       ///< for the answer to what was prepared
  int answers_to_skip_ = 0;  ///< to settings that are in force
  std::optional<Answer> answer_;
  std::optional<Silence> unanswered_;  ///< while it waits for that
  Backoff backoff_;
  TimePoint started_{};
  TimePoint start_again_{};
};

}  // namespace coupler::device
