// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <optional>
#include <thread>
#include <vector>

#include "coupler/device/node/point_hooks.hpp"
#include "coupler/device/replay/differences.hpp"
#include "coupler/device/replay/played_map.hpp"
#include "coupler/device/replay/recording.hpp"
#include "coupler/device/supervisor/shared_memory.hpp"

namespace coupler::device {

struct ReplayOptions {
  double speed = 1;              ///< so many times as fast
  bool loop = false;             ///< again from the beginning, until the node is stopped
  bool faults = true;            ///< exceptions and silence, too
  Nanoseconds from{};            ///< since the beginning of the recording
  Nanoseconds tolerance{};       ///< as Differences'
  bool names_points = false;     ///< those that are compared must be written
  std::vector<bool> compared{};  ///< by point
};

/// Plays a recording in place of a firmware: each point has the value that it had, from the first request on
/// that the node gets. A point that a client writes is the client's from then on, and what it writes is
/// compared with the recording. What has the same time in it becomes true at once for clients. At the end the
/// node is stopped, and the differences have been told on stderr.
class Player final : public PointHooks {
 public:
  /// All of them outlive it. What it counts is shared with forked processes.
  Player(const Recording& recording, const PlayedMap& played, ReplayOptions options);
  ~Player() override;

  void serving_began() override;
  void put_new_values(Image& image, Changes& changes) override;
  [[nodiscard]] bool accept(std::uint32_t point, const std::uint16_t* registers) override;
  [[nodiscard]] bool shows_identity() const noexcept override { return !recording_.is_foreign(); }
  [[nodiscard]] bool answers() override;
  [[nodiscard]] std::string_view why_it_ends() const noexcept override {
    return is_over_ ? "the recording is over" : std::string_view();
  }
  [[nodiscard]] std::optional<modbus::Exception> refuse_read(Table table, modbus::Range range) override;

  /// In any of the processes: how many differences there were.
  std::uint32_t differences() const { return shared_[0].differences; }
  /// The process that served has died: what was compared is not known.
  bool is_broken() const { return shared_[0].is_broken; }

 private:
  using Clock = std::chrono::steady_clock;
  /// The data that outlives a process that serves.
  struct Shared {
    std::atomic<Clock::rep> started{0};  ///< 0: no request yet
    std::atomic<std::uint32_t> differences{0};
    std::atomic<bool> is_broken{false};
  };

  Clock::duration real(Nanoseconds recorded) const;
  Clock::time_point first_round() const;
  void apply_what_is_before();
  void play();
  bool wait_for_start();
  bool play_once(Clock::time_point begin);
  void apply(const Recording::Event& event);
  void tell(const std::vector<Differences::Difference>& found);
  void tell_unwritten();
  void begin_again();
  void end();
  bool wait_and_tell(Nanoseconds recorded, Clock::time_point real_time);
  Nanoseconds now() const;  ///< of the recording
  bool sleep_until(Clock::time_point time);

  void show(std::uint32_t point, const std::uint16_t* registers);

  const Recording& recording_;
  const PlayedMap& played_;
  std::vector<std::optional<std::uint32_t>>
      recorded_;  ///< by point of the map that is served: in the recording's
  const ReplayOptions options_;
  std::atomic<bool> is_over_{false};
  const pid_t supervisor_;  ///< the process in which this was made
  SharedArray<Shared> shared_{1};
  UrgentMutex mutex_;  ///< of the next four, which the thread of the requests uses too
  Differences differences_;
  std::vector<std::uint16_t> masked_;
  std::vector<std::optional<modbus::Exception>> exceptions_;  ///< by point
  bool are_new_exceptions_ = false;                           ///< since they were shown
  /// The exceptions that the image shows, for the thread of the requests.
  std::vector<std::optional<modbus::Exception>> shown_exceptions_;
  Clock::time_point told_at_{};
  std::atomic<bool> is_lost_{false};
  std::atomic<Clock::rep> round_began_{0};
  std::size_t applied_ = 0;  ///< events, before the first round
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace coupler::device
