// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/host/core/stamp.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// The points of a tool, each a bit. The first two are outputs, the others inputs.
enum class ToolPart : std::uint8_t { close, open, closed, opened, holds };
constexpr std::size_t tool_parts = 5;
constexpr std::array<ToolPart, 3> tool_inputs{ToolPart::closed, ToolPart::opened, ToolPart::holds};
constexpr bool is_output(ToolPart part) { return part == ToolPart::close || part == ToolPart::open; }
/// The name of the point; empty: the tool does not have it.
std::string_view point_of(const Tool& tool, ToolPart part);

enum class ToolEnd : std::uint8_t { open, closed };
constexpr ToolEnd other_end(ToolEnd end) { return end == ToolEnd::closed ? ToolEnd::open : ToolEnd::closed; }
constexpr ToolPart input_of(ToolEnd end) {
  return end == ToolEnd::closed ? ToolPart::closed : ToolPart::opened;
}
constexpr ToolPart output_of(ToolEnd end) {
  return end == ToolEnd::closed ? ToolPart::close : ToolPart::open;
}

enum class ToolState : std::uint8_t {
  unknown,
  opening,
  open,
  closing,
  closed,
  holding,       ///< it holds a part
  stuck,         ///< it reached no end in time
  contradictory  ///< the inputs of both ends are on
};

/// How a goal has ended.
struct ToolResult {
  enum class How : std::uint8_t {
    reached,
    holds,     ///< it holds a part
    stuck,     ///< at neither end in time, or at its closed end without the part
    aborted,   ///< something else ended it
    replaced,  ///< a newer goal did
    cancelled
  };
  How how = How::aborted;
  std::string text;                  ///< "closed after 212 ms"; of aborted: why
  std::optional<double> position{};  ///< of the tool then; empty if unknown. Tools sets it

  bool is_success() const { return how == How::reached || how == How::holds; }
};

struct ToolStatus {
  ToolState state = ToolState::unknown;
  Time since{};
  std::string reason;  ///< "closed after 212 ms"; may be empty
};

/// The rules of one tool: which output is driven next, when a goal has ended and how, and the state that the
/// inputs and the last goal show. An output is switched on only after the device has acknowledged that the
/// other one is off. It is told everything, and does nothing itself: see the take_…() functions.
class ToolMotion {
 public:
  /// An output that is to be switched.
  struct Command {
    std::uint64_t number = 0;  ///< no other command of the tool has it
    ToolPart output = ToolPart::close;
    bool on = false;
  };

  /// The storage of the tool must outlive it.
  ToolMotion(const Tool& tool, Time now) : tool_(tool), status_{ToolState::unknown, now, {}} {}

  /// Begins a goal. It replaces one that has not ended yet.
  void begin(ToolEnd end, Time now);
  /// Cancels the goal, if there is one: the tool does what Tool::on_cancel says, and the goal ends when the
  /// device has acknowledged the last command. A goal that has already reached its end keeps its result.
  void cancel(Time now);
  /// Somebody else drives its outputs: aborts the goal, if there is one. Where no input says where the tool
  /// is, that is not known any more.
  void disturb(const std::string& why, Time now);
  /// The device is offline: the same, and nothing is known of its inputs either.
  void go_offline(Time now);
  /// The part had this value at the time of the stamp. Values of a part come in their order. Returns whether
  /// step() is to be called.
  bool see(ToolPart part, bool on, const Stamp& stamp, Time now);
  /// Nothing is known of the part between its last value and the next one.
  void lose(ToolPart part, Time now);
  /// The result of a command; `failure` is why the output was not switched, or empty.
  void on_written(std::uint64_t number, const std::string& failure, Time now);
  /// Decides what time alone decides. Returns when to call it again.
  Time step(Time now);

  /// Takes the command that is to be carried out now: each is returned once.
  std::optional<Command> take_command();
  /// Takes the inputs of which a new value is needed.
  std::vector<ToolPart> take_asked();
  /// Takes the results of the goals that have ended, in their order.
  std::vector<ToolResult> take_results();
  const ToolStatus& status() const { return status_; }
  /// Returns whether the part has a value.
  bool knows(ToolPart part) const { return level(part).known; }
  /// Returns the joint position; call it only while the inputs have good values. The middle if nothing shows
  /// that the tool is at an end; nothing if the inputs contradict each other.
  std::optional<double> position() const;
  /// Returns when the tool reached its position; Time::min() if the inputs alone show where it is.
  Time there_since() const;
  /// The status, if it is not what the last call gave.
  std::optional<ToolStatus> take_status();

 private:
  using How = ToolResult::How;
  enum class Phase : std::uint8_t {
    idle,
    releasing,  ///< the other output is switched off
    driving,    ///< the output is switched
    moving,
    letting_go,  ///< the output is switched off at the end
    stopping     ///< its goal was cancelled while a command was on its way
  };
  struct Level {
    bool known = false;
    bool on = false;
    Stamp first;         ///< of the first value since it became so
    Stamp last;          ///< of the last value
    bool asked = false;  ///< for a newer one
  };
  /// The state of an output that the device has acknowledged.
  struct Driven {
    bool on = false;
    Time since{};
  };

  const Level& level(ToolPart part) const { return levels_[static_cast<std::size_t>(part)]; }
  Level& level(ToolPart part) { return levels_[static_cast<std::size_t>(part)]; }
  std::optional<Driven>& driven(ToolPart output) { return driven_[static_cast<std::size_t>(output)]; }
  std::string_view name(ToolPart part) const { return point_of(tool_, part); }
  bool has(ToolPart part) const { return !name(part).empty(); }
  /// Returns whether the goal depends on the input.
  bool counts(ToolPart input) const {
    return has(input) && (input != ToolPart::holds || goal_ == ToolEnd::closed);
  }
  Command motive() const;
  bool is_on(ToolPart input) const { return level(input).known && level(input).on; }
  bool is_contradictory() const { return is_on(ToolPart::closed) && is_on(ToolPart::opened); }
  bool is_since_driven(ToolPart input) const;
  bool is_seen_on(ToolPart input) const;
  bool is_seen_off(ToolPart input) const;
  void start(ToolEnd end, Time now);
  void abort(How how, const std::string& why, Time now);
  void send(ToolPart output, bool on, Phase phase);
  void drive();
  void check_output(ToolPart output, bool on, const Stamp& stamp, Time now);
  bool ends(Time now);
  void look(Time now);
  bool is_at_end(Time now) const;
  Time end_at() const;
  bool is_without_part() const;
  bool is_there() const;
  std::string why_stuck() const;
  void arrive(How how, std::string text, std::optional<ToolState> rest, Time now);
  void finish(Time now);
  void give_result();
  ToolState state() const;
  std::string reason_of(ToolState state) const;
  void update(Time now, const std::string& reason);
  Time ask(Time now);
  std::string after(Time now) const;

  const Tool tool_;
  std::array<Level, tool_parts> levels_{};
  std::array<std::optional<Driven>, 2> driven_{};
  Phase phase_ = Phase::idle;
  ToolEnd goal_ = ToolEnd::open;
  Time since_{};                   ///< the goal came, or its output was switched
  bool has_goal_ = false;          ///< it has no result yet; a tool may move on after a cancelled one
  bool is_cancelled_ = false;      ///< the goal
  ToolResult result_;              ///< of the goal, as far as that is known
  std::optional<ToolState> rest_;  ///< where the last goal ended, as far as no input says so
  Command last_;                   ///< the last command
  bool is_given_ = true;           ///< it has been given
  bool has_driven_ = false;        ///< a command of the last goal has been given
  std::vector<ToolPart> asked_;    ///< not given yet
  std::vector<ToolResult> results_;
  ToolStatus status_;
  bool is_reason_of_goal_ = false;
  bool is_status_new_ = true;
};

}  // namespace coupler::host
