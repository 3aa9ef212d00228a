// SPDX-License-Identifier: Apache-2.0
// Random tools with random faults: what is said of a goal is what has happened to the simulated cylinder.
#include <algorithm>
#include <optional>
#include <random>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "coupler/host/motion/tool_motion.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;
using P = ToolPart;

enum class Fault {
  none,
  jams_at_end,
  jams_midway,
  end_unseen,
  other_end_always_seen,
  bounces,
  offline,
  foreign,
  cancelled  ///< before it can be at its end
};

Time at(int ms) { return Time(milliseconds(ms)); }

struct Case {
  explicit Case(unsigned seed) : random(seed) {
    const int drives = pick(0, 2);
    if (drives != 1) tool.close = "close";
    if (drives != 0) tool.open = "open";
    if (pick(0, 3) != 0) tool.closed = "closed";
    if (pick(0, 3) != 0) tool.opened = "opened";
    if (pick(0, 2) == 0) tool.holds = "holds";
    tool.timeout = milliseconds(800);
    fault = static_cast<Fault>(pick(0, 8));
    if (tool.closed.empty() || tool.opened.empty()) tool.travel = milliseconds(travel + 60);
    if (fault == Fault::bounces) tool.settle = milliseconds(15);
    tool.empty = pick(0, 1) == 0 ? OnEmpty::ok : OnEmpty::abort;
    tool.hold = pick(0, 2) != 0;
    tool.on_cancel = static_cast<OnCancel>(pick(0, 2));
    end = pick(0, 1) == 0 ? ToolEnd::open : ToolEnd::closed;
    has_part = end == ToolEnd::closed && !tool.holds.empty() && pick(0, 1) == 0;
    position = end == ToolEnd::closed ? 0 : travel;
    // A spring holds a tool with one output where it is.
    if (tool.open.empty()) close = end == ToolEnd::open;
    if (tool.close.empty()) open = end == ToolEnd::closed;
  }

  int pick(int least, int most) { return std::uniform_int_distribution<int>(least, most)(random); }
  bool has_end() const { return !(end == ToolEnd::closed ? tool.closed : tool.opened).empty(); }
  bool has_other_end() const { return !(end == ToolEnd::closed ? tool.opened : tool.closed).empty(); }

  /// The output that moves it.
  std::string_view driven() const {
    return tool.open.empty() || (end == ToolEnd::closed && !tool.close.empty()) ? tool.close : tool.open;
  }

  /// The beginning of what is to be said.
  std::string truth() const {
    if (fault == Fault::offline) return "the connection to the device was lost";
    if (fault == Fault::cancelled) return "cancelled after";
    if (fault == Fault::foreign) return fmt::format("{} was switched", driven());
    const bool stays_seen = fault == Fault::jams_at_end || fault == Fault::other_end_always_seen;
    if (stays_seen && has_other_end())
      return fault == Fault::other_end_always_seen && has_end() && !has_part
                 ? "closed and opened are both on"
                 : fmt::format("stuck: {} is still on", end == ToolEnd::closed ? "opened" : "closed");
    const bool moves = fault != Fault::jams_at_end && fault != Fault::jams_midway;
    if (has_part && moves) return "holds a part";
    if (has_end() && (!moves || fault == Fault::end_unseen)) return "stuck: neither end";
    if (end == ToolEnd::open) return "open after";
    return !tool.holds.empty() && tool.empty == OnEmpty::abort ? "closed without a part" : "closed after";
  }

  void move() {
    const int before = position;
    const bool closes = tool.close.empty() ? !open : close;
    const bool opens = tool.open.empty() ? !close : open;
    position += closes ? 1 : opens ? -1 : 0;
    const int most = has_part ? travel * 2 / 3 : travel;
    position = std::clamp(position, 0, most);
    const int jam = fault == Fault::jams_at_end ? (end == ToolEnd::closed ? 0 : travel) : travel / 2;
    if ((fault == Fault::jams_at_end || fault == Fault::jams_midway) && before == jam) position = jam;
  }

  bool level(P part, int now) const {
    switch (part) {
      case P::close: return close;
      case P::open: return open;
      case P::holds: return has_part && position == travel * 2 / 3;
      case P::closed:
      case P::opened: break;
    }
    const bool is_end = part == (end == ToolEnd::closed ? P::closed : P::opened);
    if (is_end && fault == Fault::end_unseen) return false;
    if (!is_end && fault == Fault::other_end_always_seen) return true;
    const bool there = position == (part == P::closed ? travel : 0);
    return there && (fault != Fault::bounces || now > bounced_until || now % 4 < 2);
  }

  std::mt19937 random;
  Tool tool{};
  const int travel = pick(80, 250);  ///< ms
  Fault fault = Fault::none;
  ToolEnd end = ToolEnd::open;
  bool has_part = false;
  int position = 0;  ///< 0 is open, `travel` is closed
  bool close = false;
  bool open = false;
  int bounced_until = 0;
};

/// Runs a goal to its end. The device announces changes, or is polled.
class Simulation {
 public:
  explicit Simulation(unsigned seed)
      : case_(seed),
        motion_(case_.tool, at(0)),
        period_(case_.pick(0, 1) == 0 ? 0 : case_.pick(3, 40)),
        cancelled_at_(case_.pick(2, 40)) {}

  ToolResult result() {
    see_all(0);
    motion_.begin(case_.end, at(1));
    for (now_ = 2; now_ < 3000; ++now_) {
      step();
      if (case_.close && case_.open) ADD_FAILURE() << "both outputs are on";
      if (const auto results = motion_.take_results(); !results.empty()) return results.front();
    }
    return {};
  }
  const Case& simulated() const { return case_; }

 private:
  void step() {
    carry_out();
    const int before = case_.position;
    case_.move();
    if (case_.position != before) case_.bounced_until = now_ + 10;
    if (now_ == 45 && case_.fault == Fault::offline) motion_.go_offline(at(now_));
    if (now_ == cancelled_at_ && case_.fault == Fault::cancelled) motion_.cancel(at(now_));
    if (now_ == 45 && case_.fault == Fault::foreign) {
      bool& output = case_.driven() == "open" ? case_.open : case_.close;
      output = !output;
    }
    for (const P asked : motion_.take_asked()) see(asked);
    if (period_ == 0)
      see_changes();
    else if (now_ % period_ == 0)
      see_all(now_);
    motion_.step(at(now_));
  }

  void carry_out() {
    if (!sent_) {
      sent_ = motion_.take_command();
      arrives_ = now_ + case_.pick(0, 8);
    }
    if (!sent_ || now_ < arrives_) return;
    (sent_->output == P::close ? case_.close : case_.open) = sent_->on;
    motion_.on_written(sent_->number, {}, at(now_));
    sent_.reset();
  }

  void see(P part) {
    if (point_of(case_.tool, part).empty()) return;
    seen_[static_cast<std::size_t>(part)] = case_.level(part, now_);
    motion_.see(part, case_.level(part, now_), {at(now_), milliseconds(0)}, at(now_));
  }
  void see_all(int ms) {
    now_ = ms;
    for (const P part : {P::close, P::open, P::closed, P::opened, P::holds}) see(part);
  }
  void see_changes() {
    for (const P part : {P::close, P::open, P::closed, P::opened, P::holds})
      if (case_.level(part, now_) != seen_[static_cast<std::size_t>(part)]) see(part);
  }

  Case case_;
  ToolMotion motion_;
  int period_;  ///< of polling; 0: the device announces changes
  int cancelled_at_;
  int now_ = 0;
  std::array<bool, tool_parts> seen_{};
  std::optional<ToolMotion::Command> sent_;
  int arrives_ = 0;
};

TEST(ToolSimulation, What_is_said_is_what_has_happened) {
  for (unsigned seed = 0; seed < 1000; ++seed) {
    Simulation run(seed);
    const std::string said = run.result().text;
    const std::string truth = run.simulated().truth();
    EXPECT_EQ(said.substr(0, truth.size()), truth) << "seed " << seed << ": " << said;
  }
}

}  // namespace
}  // namespace coupler::host
