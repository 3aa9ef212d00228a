// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coupler/host/core/call_queue.hpp"
#include "coupler/host/core/scheduled.hpp"
#include "coupler/host/motion/joints.hpp"
#include "coupler/host/motion/tools.hpp"
#include "coupler/host/motion/trajectory_motion.hpp"

namespace coupler::host {

/// The trajectories of a device: the newest goal, and those before it that have no result yet. The device's
/// thread says what became of scheduled writes, and another thread, which makes them and gives the results,
/// calls step().
class Trajectories {
 public:
  using Done = std::function<void(const TrajectoryResult&)>;
  /// The functions that it calls; all but the last from step(). None of them may wait for anything.
  struct Calls {
    std::function<void(const ScheduledWrite&, Reply<ScheduleAnswer>::Give)> schedule;
    std::function<void(WritesFrom, Reply<CallAnswer>::Give)> cancel;
    std::function<void()> wake;  ///< makes another thread call step() soon
  };

  /// The storage of `map`, and the joints and tools, must outlive it. Each call of `schedule` and `cancel`
  /// must have its answer before it is destroyed.
  Trajectories(const Map& map, const Joints& joints, Tools& tools, Window window, Calls calls);

  // Any thread may make these calls.

  /// Begins a goal, which replaces the one before from its start on. step() calls `done` exactly once; so
  /// does begin() after end().
  void begin(GoalKey key, TrajectoryGoal goal, Time received, const Done& done);
  /// Cancels a goal that has no result yet, and what those that it has replaced still do.
  void cancel(GoalKey key);
  /// Somebody else writes the point: a goal with a joint that it drives is aborted.
  void disturb(std::uint32_t point, const std::string& why);
  /// Aborts all goals. Once it has returned, nothing more is driven for an earlier goal.
  void disturb_all(const std::string& why);
  /// Aborts all goals, also those to come.
  void end(const std::string& why);

  /// The state of a goal at a time.
  struct Progress {
    GoalKey key;
    std::vector<std::size_t> joints;
    std::vector<double> desired;
    std::chrono::nanoseconds from_start;
  };
  /// Returns the goal that is not ending, if there is one.
  std::optional<Progress> progress(Time now);

  /// Decides, and does what follows. Returns the time at which it is to be called again.
  Time step(Time now);

  // The device's thread makes these calls, as those of Sink.

  /// Returns whether a trajectory has scheduled it.
  bool on_scheduled(const ScheduledOutcome& outcome);
  void on_online(bool online);

 private:
  struct Running {
    std::uint64_t id;  ///< no other has it
    GoalKey key;
    Done done;
    std::chrono::nanoseconds wall_start;
    TrajectoryMotion motion;
  };
  /// Work that is done without mutex_.
  struct Work {
    std::vector<std::pair<Running*, std::size_t>> changes;
    std::vector<std::pair<Running*, TrajectoryMotion::Withdrawal>> withdrawals;
    std::vector<std::pair<Done, TrajectoryResult>> results;
  };
  GoalKey tool_key(const Running& running, std::size_t joint) const;
  template <class Change>
  void tell(std::uint64_t id, Change change);
  void end_replaced();
  void carry_out(Running& running, std::size_t change);
  void withdraw(Running& running, const TrajectoryMotion::Withdrawal& what);
  template <class Change>
  void each(Change change);

  const Map map_;
  const Joints& joints_;
  Tools& tools_;
  const Window window_;
  const Calls calls_;

  std::mutex driving_;  ///< held from deciding until what was decided is handed over; before mutex_
  std::mutex mutex_;
  std::list<Running> running_;                              ///< oldest first
  std::vector<std::pair<Done, TrajectoryResult>> refused_;  ///< to be told by step()
  std::uint64_t last_id_ = 0;
  bool is_online_ = false;
  std::string end_reason_;  ///< empty: it has not ended
};

}  // namespace coupler::host
