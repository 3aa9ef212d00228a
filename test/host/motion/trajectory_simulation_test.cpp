// SPDX-License-Identifier: Apache-2.0
// Random trajectories with random faults, replacements and cancels: what is said of a goal is what the
// simulated lines did.
#include <algorithm>
#include <array>
#include <deque>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "coupler/host/core/wall_time.hpp"
#include "coupler/host/motion/trajectories.hpp"
#include "test/host/motion/sample_joints.hpp"
#include "test/host/motion/simulated_outputs.hpp"
#include "test/host/motion/wanted_changes.hpp"

namespace coupler::host {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

/// A goal, and what became of it.
struct Asked {
  std::vector<std::size_t> axes;
  std::vector<Wanted> wanted;  ///< by time
  Duration duration{};
  bool is_accepted = false;
  std::uint64_t owner = 0;  ///< of what it schedules
  Time received{};
  Time start{};
  Time ends = Time::max();    ///< nothing that is due then or later may be handed over any more
  Time is_cut = Time::max();  ///< the connection was lost meanwhile
  std::size_t under_way = 0;
  std::size_t told = 0;  ///< have been made, as the driver knows
  Time is_over = Time::max();
  std::vector<TrajectoryResult> results;

  bool has(std::size_t axis) const { return std::find(axes.begin(), axes.end(), axis) != axes.end(); }
};

/// It makes a step only when that is asked for.
class SimulatedTrajectories : public SampleJoints {
 public:
  explicit SimulatedTrajectories(unsigned seed) : chance_(seed) { trajectories_.on_online(true); }
  void TestBody() override {}

  void run() {
    begin();
    for (int i = pick(0, 2); i > 0; --i)
      time_.in(std::chrono::nanoseconds(pick(1, 1'500'000'000)), [this] { begin(); });
    for (int i = pick(0, 3); i > 0; --i) time_.in(milliseconds(pick(1, 2500)), [this] { disturb(); });
    for (milliseconds at{}; at < end; at += period) time_.in(at, [this] { poll(); });
    time_.in(end, [this] {
      end_all([](const Asked&) { return true; });
      trajectories_.end("the driver ends");
    });
    int at_once = 0;
    while (is_woken_ || time_.next() < Time::max()) {
      const Time next = is_woken_ ? time_.now() : std::min(time_.next(), next_step_);
      at_once = next > time_.now() ? 0 : at_once + 1;
      if (at_once > 1000) return fail("it is stepped without end");
      time_.advance(next);
      if (is_woken_ || next_step_ <= time_.now()) {
        is_woken_ = false;
        next_step_ = trajectories_.step(time_.now());
      } else {
        time_.happen();
      }
    }
    for (const Asked& goal : goals_) judge(goal);
  }

 private:
  static constexpr milliseconds end{6000};
  static constexpr milliseconds period{50};  ///< of polling

  int pick(int least, int most) { return chance_.pick(least, most); }
  static void fail(const std::string& what) { ADD_FAILURE() << what; }

  // What clients and others do.

  void begin() {
    TrajectoryGoal goal;
    Asked& asked = goals_.emplace_back();
    for (std::size_t axis = 0; axis < sample_axes.size(); ++axis)
      if (chance_.is(0.6)) asked.axes.push_back(axis);
    if (asked.axes.empty()) asked.axes.push_back(0);
    for (const std::size_t axis : asked.axes) goal.joints.emplace_back(sample_axes[axis].name);
    auto at = std::chrono::nanoseconds(chance_.is(0.5) ? 0 : pick(1, 300'000'000));
    const int longest = chance_.is(0.3) ? 10'000 : 200'000;  // µs between two points
    for (int left = pick(1, 25); left > 0; --left) {
      std::vector<double> positions;
      for (const std::size_t axis : asked.axes)
        positions.push_back(chance_.real(0, sample_axes[axis].highest));
      goal.points.push_back({positions, at});
      asked.duration = at;
      at += microseconds(pick(1, longest));
    }
    for (std::size_t i = 0; i < asked.axes.size(); ++i) add_wanted(goal, i, asked.axes[i], asked.wanted);
    std::stable_sort(asked.wanted.begin(), asked.wanted.end(),
                     [](const Wanted& a, const Wanted& b) { return a.at < b.at; });
    if (chance_.is(0.4)) goal.start = measured_wall_time().of(time_.now() + milliseconds(pick(50, 1200)));
    if (chance_.is(0.2))
      goal.goal_tolerance = {{goal.joints[0], sample_axes[asked.axes[0]].highest / 2 + 0.5}};
    send(goal, asked);
  }
  void send(const TrajectoryGoal& goal, Asked& asked) {
    const std::uint64_t number = goals_.size();
    asked.received = time_.now();
    trajectories_.begin({this, number}, goal, asked.received, [this, &asked](const TrajectoryResult& result) {
      asked.results.push_back(result);
      asked.is_over = time_.now();
    });
    const auto progress = trajectories_.progress(asked.received);
    asked.is_accepted = progress && progress->key.number == number;
    if (!asked.is_accepted) return;
    asked.start = asked.received - progress->from_start;
    asked.owner = ++accepted_;
    for (Asked& before : goals_)
      if (&before != &asked && asked.start <= before.start + before.duration)
        before.ends = std::min(before.ends, asked.start);
  }

  void disturb() {
    const auto axis = static_cast<std::size_t>(pick(0, 2));
    switch (pick(0, 8)) {
      case 0: {
        const auto number = static_cast<std::size_t>(pick(1, static_cast<int>(goals_.size())));
        goals_[number - 1].ends = Time::min();
        return trajectories_.cancel({this, number});
      }
      case 1: return overwrite(axis);  // by a client of whom the driver knows nothing
      case 2:
        end_all([axis](const Asked& goal) { return goal.has(axis); });
        trajectories_.disturb(index(sample_axes[axis].point), "it was written directly");
        return time_.in(delay_, [this, axis] { overwrite(axis); });
      case 3:
        end_all([](const Asked&) { return true; });
        trajectories_.disturb_all("safe values were requested");
        return time_.in(delay_, [this] {
          for (std::size_t each = 0; each < sample_axes.size(); ++each) overwrite(each);
        });
      case 4: return cut();
      case 5: return outputs_.fail(chance_.is(0.5) ? 0.1 : 0);
      default:
        for (int ms = 0; ms < 1500; ms += pick(1, 100))  // others come and go
          time_.in(milliseconds(ms), [this] { outputs_.occupy(static_cast<std::size_t>(pick(58, 64))); });
        return time_.in(milliseconds(1500), [this] { outputs_.occupy(0); });
    }
  }
  template <class Which>
  void end_all(Which which) {
    for (Asked& goal : goals_)
      if (which(goal)) goal.ends = Time::min();
  }
  void overwrite(std::size_t axis) {
    outputs_.overwrite(index(sample_axes[axis].point));
    set(axis, 0);
  }
  void cut() {
    if (!outputs_.is_online()) return;
    end_all([](const Asked&) { return true; });
    for (Asked& goal : goals_)
      if (goal.is_over == Time::max()) goal.is_cut = time_.now();
    outputs_.cut(milliseconds(pick(0, 500)));
    trajectories_.on_online(false);
    values.online(false);
    time_.in(milliseconds(pick(501, 900)), [this] {
      outputs_.plug();
      values.online(true);
      trajectories_.on_online(true);
    });
  }
  void poll() {
    for (std::size_t axis = 0; axis < sample_axes.size(); ++axis)
      outputs_.tell([this, which = index(sample_axes[axis].point), value = level_at(axis, time_.now()),
                     at = time_.now()] {
        const Point& point = map->map().points[which];
        values.store({point.table, range(point), {which}}, {&value, 1}, {at, {}}, at);
      });
  }

  // What is right.

  /// Returns null if nobody wants it.
  std::pair<Asked*, Wanted*> find(const ScheduledWrite& what) {
    for (Asked& goal : goals_)
      for (Wanted& wanted : goal.wanted)
        if (index(sample_axes[wanted.axis].point) == what.write.point &&
            wanted.value == what.write.registers[0] && goal.owner == what.owner &&
            std::chrono::abs(goal.start + wanted.at - what.due) < microseconds(1))
          return {&goal, &wanted};
    return {};
  }
  void handed_over(const ScheduledWrite& what, Reply<ScheduleAnswer>::Give give) {
    Asked* const goal = find(what).first;
    if (goal == nullptr) return fail("something is handed over that nobody wants");
    if (what.due > time_.now() + window_.horizon) fail("it is handed over before the horizon");
    if (what.due >= goal->ends) fail("it is handed over though its goal has ended");
    if (++goal->under_way > window_.most) fail("more are under way than may be");
    outputs_.schedule(what, std::move(give));
  }
  void driven(const ScheduledWrite& what) {
    const auto [goal, wanted] = find(what);
    if (wanted->is_made) fail("it is made twice");
    if (time_.now() < what.due) fail("it is made before its time");
    const bool is_unnoticed = time_.now() > goal->is_cut && time_.now() <= goal->is_cut + window_.horizon;
    if (time_.now() > goal->is_over && !is_unnoticed) fail("it is made after the result was given");
    wanted->is_made = true;
    for (const Wanted& other : goal->wanted)
      if (other.axis == wanted->axis && other.is_made && other.at > wanted->at)
        fail("a later one was made before");
    set(wanted->axis, wanted->value);
  }
  void outcome(const ScheduledOutcome& told, const ScheduledWrite& what) {
    Asked& goal = *find(what).first;
    --goal.under_way;
    if (told.result == ScheduledOutcome::Result::done) ++goal.told;
    if (!trajectories_.on_scheduled(told)) fail("nobody wants to know of its outcome");
  }
  void judge(const Asked& goal) const {
    ASSERT_EQ(goal.results.size(), 1U) << "each goal has one result";
    const auto& [how, code, said] = goal.results[0];
    const auto made = static_cast<std::size_t>(
        std::count_if(goal.wanted.begin(), goal.wanted.end(), [](const Wanted& one) { return one.is_made; }));
    if (!goal.is_accepted) {
      EXPECT_EQ(made, 0U) << said;
      return;
    }
    static const std::regex numbers("(^|; )([0-9]+) (of [0-9]+ )?changes?");
    std::smatch number;
    ASSERT_TRUE(std::regex_search(said, number, numbers)) << said;
    EXPECT_EQ(std::stoul(number[2]), goal.told) << said;
    // What was made before the node noticed that the cable is cut, the driver cannot know.
    EXPECT_TRUE(made == goal.told || (made > goal.told && goal.is_cut < Time::max()))
        << made << " were made: " << said;
    if (how != TrajectoryResult::How::done) return;
    EXPECT_GE(goal.is_over, goal.start + goal.duration);
    EXPECT_EQ(made, goal.wanted.size()) << said;
  }
  std::uint16_t level_at(std::size_t axis, Time when) const {
    std::uint16_t level = 0;
    for (const auto& [at, value] : levels_[axis])
      if (at <= when) level = value;
    return level;
  }
  void set(std::size_t axis, std::uint16_t value) { levels_[axis].emplace_back(time_.now(), value); }

  Chance chance_;
  SimulatedTime time_{now()};
  const Duration delay_ = microseconds(chance_.is(0.5) ? pick(0, 500) : pick(0, 40'000));
  const Window window_{milliseconds(pick(200, 1000)), static_cast<std::size_t>(pick(2, 32))};
  bool is_woken_ = true;
  Time next_step_ = Time::max();
  std::deque<Asked> goals_;
  std::uint64_t accepted_ = 0;
  std::array<std::vector<std::pair<Time, std::uint16_t>>, 3> levels_;
  SimulatedOutputs outputs_{
      time_,
      chance_,
      delay_,
      {[this](const ScheduledWrite& what) { driven(what); },
       [this](const ScheduledWrite& what) { --find(what).first->under_way; },
       [this](const ScheduledOutcome& told, const ScheduledWrite& what) { outcome(told, what); }, fail}};
  Trajectories trajectories_{
      map->map(),
      joints,
      tools,
      window_,
      {[this](const ScheduledWrite& what, Reply<ScheduleAnswer>::Give give) {
         handed_over(what, std::move(give));
       },
       [this](const WritesFrom& which, const Reply<CallAnswer>::Give& give) { outputs_.cancel(which, give); },
       [this] { is_woken_ = true; }}};
};

TEST(TrajectorySimulation, What_is_said_is_what_the_lines_did) {
  for (unsigned seed = 0; seed < 2000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    SimulatedTrajectories(seed).run();
  }
}

}  // namespace
}  // namespace coupler::host
