// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coupler/base/span.hpp"
#include "coupler/host/core/value_table.hpp"
#include "coupler/host/core/write.hpp"
#include "coupler/host/motion/tool_motion.hpp"

namespace coupler::host {

/// The sender of a goal, and the sender's number for it.
struct GoalKey {
  const void* sender = nullptr;  ///< null: it is never cancelled
  std::uint64_t number = 0;
};

/// Where a tool is, as a joint.
struct JointPosition {
  double position = 0;
  Time at{};  ///< it was still there then
};

/// The tools of a device. The device's thread says what it has read, and another thread, in which commands
/// and results are given, calls step().
class Tools {
 public:
  using Done = std::function<void(const ToolResult&)>;
  /// The functions that it calls. None of them may wait for anything.
  struct Calls {
    std::function<void(const Write&)> write;       ///< from step(); the write has a listener
    std::function<void(std::uint32_t point)> ask;  ///< makes the device read a point soon; from step()
    std::function<void()> wake;                    ///< makes another thread call step() soon
    std::function<void(std::size_t tool, const ToolStatus&)>
        show;  ///< its status is another one; from step()
  };

  /// The storage of `map`, and the table, must outlive it. Every write must have its result before it is
  /// destroyed.
  Tools(const Map& map, const ValueTable& values, Time now, Calls calls);

  // Any thread may make these calls.

  /// Returns whether a tool has the point.
  bool has(std::uint32_t point) const { return !places_[point].empty(); }
  /// Begins a goal of a tool. step() calls `done` exactly once; so does begin() after end().
  void begin(std::size_t tool, ToolEnd end, Time now, const Done& done, GoalKey key = {});
  /// Cancels a goal that has no result yet.
  void cancel(std::size_t tool, GoalKey key, Time now);
  /// Aborts it: nothing more is driven.
  void abort(std::size_t tool, GoalKey key, const std::string& why, Time now);
  /// Returns nothing while the device is offline, an input has no good value, or both ends are seen.
  std::optional<JointPosition> position(std::size_t tool, Time now);
  /// Somebody else writes the point: the tools that have it as an output end their goals.
  void disturb(std::uint32_t point, const std::string& why, Time now);
  /// The same for all tools. Once it has returned, no write is made for an earlier goal.
  void disturb_all(const std::string& why, Time now);
  /// Aborts all goals, also those to come.
  void end(const std::string& why, Time now);

  /// Decides, and does what follows. Returns the time at which it is to be called again.
  Time step(Time now);

  // The device's thread makes these calls, as those of Sink.

  void on_values(Span<const std::uint32_t> points, Time now);
  void on_no_values(Span<const std::uint32_t> points, Time now);
  void on_gap(Time now);
  void on_online(bool online, Time now);

 private:
  /// One of the points of a tool.
  struct Place {
    std::size_t tool;
    ToolPart part;
  };
  /// A command on its way.
  struct Sent : WriteListener {
    Sent(Tools& owner, std::size_t of_tool, const ToolMotion::Command& command)
        : tools(owner), tool(of_tool), number(command.number) {}
    void on_result(const WriteResult& result) override { tools.on_result(*this, result); }
    Tools& tools;
    std::size_t tool;
    std::uint64_t number;
    Time at{};                           ///< when it got its result
    std::optional<std::string> failure;  ///< none: it has no result yet; empty: it was carried out
  };
  struct Goal {
    GoalKey key;
    Done done;
  };
  /// A value of a part that the motion has seen.
  struct Seen {
    std::uint64_t number = 0;  ///< see ValueTable::Value
    Time at{};                 ///< the latest time at which the value was still this
  };
  struct Running {
    Running(const Tool& tool, Time now) : motion(tool, now) {}
    std::uint32_t point(ToolPart part) const { return points[static_cast<std::size_t>(part)]; }
    ToolMotion motion;
    std::array<std::uint32_t, tool_parts> points{};  ///< of the parts that it has
    std::array<Seen, tool_parts> seen{};
    std::vector<Goal> goals;  ///< without a result, oldest first
  };
  /// Work that is done without mutex_.
  struct Work {
    std::vector<Write> writes;
    std::vector<std::uint32_t> asked;
    std::vector<std::pair<std::size_t, ToolStatus>> shown;
    std::vector<std::pair<Done, ToolResult>> results;
  };

  template <class Change>
  void change_goal(std::size_t tool, GoalKey key, Change change);
  void on_result(Sent& sent, const WriteResult& result);
  std::optional<JointPosition> position_of(std::size_t tool, Time now) const;
  std::optional<Time> known_at(const Running& running, ToolPart part, Time now) const;
  void take_results();
  void take(std::size_t tool, Time now, Work& work);
  template <class Change>
  void each_place(Span<const std::uint32_t> points, Change change);

  const Map map_;
  const ValueTable& values_;
  const Calls calls_;
  std::vector<std::vector<Place>> places_;  ///< by point

  std::mutex writing_;  ///< held from taking a command until its write is made; before mutex_
  std::mutex mutex_;
  std::vector<Running> running_;  ///< by tool
  std::list<Sent> sent_;
  bool is_online_ = false;
  std::string end_reason_;  ///< empty: it has not ended
};

}  // namespace coupler::host
