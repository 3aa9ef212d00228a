// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coupler/host/core/scheduled.hpp"
#include "coupler/host/motion/trajectory_plan.hpp"

namespace coupler::host {

/// How a trajectory has ended.
struct TrajectoryResult {
  enum class How : std::uint8_t {
    done,
    aborted,
    replaced,  ///< by a newer goal
    cancelled
  };
  How how = How::aborted;
  TrajectoryCode code = TrajectoryCode::successful;
  std::string text;  ///< "37 changes, at most 0.061 ms late (± 0.030)"; or why it has ended
};

/// How early changes are handed over, and how many at a time.
struct Window {
  Duration horizon = std::chrono::seconds(1);  ///< how long before they are due
  std::size_t most = 32;                       ///< changes of axes
};

/// The rules of one trajectory: which changes are handed over next, to be made when they are due, and when
/// the goal has ended and how. It is told everything, and does nothing itself: see the take_…() functions. A
/// goal has exactly one result, once it is known of each change that was handed over what became of it.
class TrajectoryMotion {
 public:
  using How = TrajectoryResult::How;

  /// The joints must outlive it. `now`: when the goal was received.
  TrajectoryMotion(TrajectoryPlan plan, const Joints& joints, Time start, Time now, Window window);

  // These calls report events. Changes are indices into plan().changes.

  /// The answer to a change of an axis that was handed over.
  void on_answer(std::size_t change, const ScheduleAnswer& answer);
  /// Reports the outcome of a scheduled write. Returns whether it is one of this trajectory.
  bool on_outcome(const ScheduledOutcome& outcome);
  /// Reports the result of a change of a tool.
  void on_tool(std::size_t change, const ToolResult& result);
  /// Ends the goal: nothing is made any more that is due at `from` or later. A goal that was replaced goes on
  /// until then, and may still be ended for another reason; one that is over by then is not replaced. `why`
  /// says why; how many changes had been made is added.
  void end(How how, const std::string& why, Time from = Time::min(),
           TrajectoryCode code = TrajectoryCode::path_tolerance_violated);
  /// Reports that the withdrawal has been made, as far as it can be. A write in doubt still gets its outcome.
  void on_withdrawn() { --withdrawals_; }

  /// Returns the position of a joint, as Joints::position() does.
  using Positions = std::function<std::optional<JointPosition>(std::size_t joint)>;
  /// Decides what time decides. Returns when to call it, and take_change(), again.
  Time step(Time now, const Positions& positions);

  /// Takes a change that is to be handed over now: that of an axis before it is due, that of a tool when it
  /// is.
  std::optional<std::size_t> take_change(Time now);
  /// Takes what is to be taken back: the changes of axes that are due at `from` or later, and, unless the
  /// goal was replaced, what its tools do.
  struct Withdrawal {
    Time from;
    How how;
    std::string why;
  };
  std::optional<Withdrawal> take_withdrawal() { return std::exchange(withdrawal_, std::nullopt); }
  /// The result, once it has ended.
  std::optional<TrajectoryResult> take_result();

  const TrajectoryPlan& plan() const { return plan_; }
  Time due(std::size_t change) const { return start_ + plan_.changes[change].at; }
  /// How late a change may be made; if it cannot be, the goal is aborted.
  Duration may_be_late(std::size_t change) const;
  Time start() const { return start_; }
  Time last_due() const { return start_ + plan_.duration(); }
  /// Returns whether the joint is one of the trajectory's.
  bool has(std::size_t joint) const;
  bool is_ending() const { return ending_.has_value(); }
  bool is_replaced() const { return ending_ && ending_->how == How::replaced; }

 private:
  enum class State : std::uint8_t {
    waiting,
    given,     ///< handed over; of an axis: not answered yet
    accepted,  ///< the write is scheduled
    over       ///< it was made, or will not be
  };
  struct Change {
    State state = State::waiting;
    std::uint32_t number = 0;  ///< of the scheduled write
    bool lacked_room = false;  ///< at the device
    bool holds = false;        ///< it is one of held_
  };

  std::size_t joint(std::size_t change) const { return plan_.changes[change].joint; }
  bool is_tool(std::size_t change) const { return joints_[joint(change)].tool != nullptr; }
  std::string describe(std::size_t change) const;
  Time hand_over_at(std::size_t change) const;
  Time await_room(Time now);
  bool has_to_wait(std::size_t change) const;
  bool is_followed(std::size_t change) const;
  void hold(std::size_t change);
  void settle(std::size_t change, const ScheduledOutcome& outcome);
  void over(std::size_t change);
  void fail(std::size_t change, const std::string& why);
  Time arrive(Time now, const Positions& positions);
  std::string why_intolerable(const Positions& positions) const;

  const TrajectoryPlan plan_;
  const Joints& joints_;
  const Time start_;
  const Time received_;
  const Window window_;
  std::vector<Change> changes_;
  std::vector<std::size_t> accepted_;    ///< changes
  std::vector<ScheduledOutcome> early_;  ///< outcomes of numbers that no answer has told yet
  std::size_t next_ = 0;                 ///< no change before it waits
  std::size_t first_open_ = 0;           ///< all changes before it are over
  std::size_t over_ = 0;                 ///< the number of changes that are
  std::size_t axes_under_way_ = 0;       ///< changes of axes that are given or accepted
  std::size_t unanswered_ = 0;
  std::size_t most_;             ///< as Window::most, and less while the device has no more places
  std::optional<Time> room_at_;  ///< when it is tried again whether the device has a place
  /// By joint: the number of its changes under way that the driver makes. The next one of the joint waits for
  /// them, since a write by the driver cancels what waits at a node.
  std::vector<unsigned> held_;
  std::size_t made_ = 0;
  Duration latest_ = Duration::min();  ///< the most that a change was late
  Duration latest_error_{};
  Time made_at_{};                          ///< the last change of an axis was made
  std::optional<TrajectoryResult> ending_;  ///< the result, which may not be given yet
  Time ends_ = Time::max();                 ///< nothing is made that is due then or later
  std::optional<Withdrawal> withdrawal_;
  unsigned withdrawals_ = 0;  ///< that are not answered
  bool is_taken_ = false;     ///< the result was taken
};

}  // namespace coupler::host
