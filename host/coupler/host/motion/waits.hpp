// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "coupler/base/span.hpp"
#include "coupler/host/core/value_table.hpp"
#include "coupler/host/motion/change_history.hpp"
#include "coupler/host/motion/wait.hpp"

namespace coupler::host {

/// How a wait has ended.
struct WaitResult {
  enum class End { met, not_met, cancelled };
  End end = End::not_met;
  std::string value;   ///< the last one that was seen, as text; empty: none
  Stamp stamp{};       ///< of `met`: of the value or the change that met the condition
  std::string reason;  ///< why it is not met
};

/// The waits for values of a device. The device's thread says what it has read, and another thread, in which
/// the results are given, calls step().
class Waits {
 public:
  using Done = std::function<void(const WaitResult&)>;
  using Number = std::uint64_t;
  static constexpr std::size_t most = 64;

  /// It knows changes from `now` on. The storage of `map`, and the table, must outlive it. `wake` makes
  /// another thread call step() soon; `ask` makes the device read a point soon whose changes it announces.
  /// Neither waits for anything.
  Waits(const Map& map, const ValueTable& values, Time now, std::function<void()> wake,
        std::function<void(std::uint32_t point)> ask);

  // Any thread may make these calls.

  /// Begins a wait, whose number no other has. step() calls `done` exactly once.
  void begin(Number number, const WaitGoal& goal, Time now, Done done);
  /// Ends a wait as cancelled. Nothing if it has ended.
  void cancel(Number number);
  /// Ends all waits, also those to come.
  void end(const std::string& reason);
  /// The point begins to be read, or is not read any more.
  void on_wanted(std::uint32_t point);

  /// Ends what is overdue and gives the results. Returns the time at which it is to be called again.
  Time step(Time now);

  // The device's thread makes these calls, as those of Sink.

  void on_values(Span<const std::uint32_t> points, bool are_told);
  void on_no_values(Span<const std::uint32_t> points, Time at);
  void on_gap();
  void on_online(bool online, Time at);

 private:
  struct Running {
    Wait wait;
    Done done;
    bool asked = false;         ///< for the reading that shows whether it has held long enough
    bool had_no_value = false;  ///< since the goal came
  };
  using Waiting = std::map<Number, Running>;
  std::string why_impossible(const WaitGoal& goal, Time now) const;
  void begin_with_last(Wait& wait, Time now) const;
  void replay(Wait& wait) const;
  std::string why_not(const Running& running, Time now) const;
  void finish(Waiting::iterator at, WaitResult result);
  Time look(Waiting::iterator at, Time now);
  void look_again(const std::function<bool(std::uint32_t point)>& is_one, Time now);

  const Map map_;
  const ValueTable& values_;
  const std::function<void()> wake_;
  const std::function<void(std::uint32_t)> ask_;

  std::mutex mutex_;
  ChangeHistory history_;
  Waiting running_;
  std::vector<std::pair<Done, WaitResult>> ended_;  ///< whose results are not given yet
  std::string end_reason_;                          ///< empty: it has not ended
};

}  // namespace coupler::host
