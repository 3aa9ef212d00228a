// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coupler/host/core/error.hpp"
#include "coupler/host/core/schedule.hpp"
#include "coupler/host/core/set_aside.hpp"
#include "coupler/map/table.hpp"
#include "coupler/modbus/range.hpp"
#include "coupler/plan/planner.hpp"

namespace coupler::host {

using plan::ReadSpan;

/// Why a read request was rejected although its points can be read.
struct RejectedRange {
  Table table;
  modbus::Range range;
  bool between_points;  ///< no point needs these addresses; otherwise they can be read in parts, not in one
                        ///< request
};

/// What it means for the map, in one line.
std::string to_string(const RejectedRange& rejected);

/// Which read request is next: the points of each rate have deadlines of their own. It learns, for the time
/// of a connection, what the device rejects.
///
/// Of the rates that are due the fastest goes first, so that a slow one with many requests delays it by one
/// request at most. After a whole cycle of one rate each other one that is due has a request, so that none
/// starves.
class PollCycle {
 public:
  /// What `map` views must outlive the cycle. All its points are wanted.
  explicit PollCycle(const Map& map);

  /// A new connection: everything is asked for again, but for what is set aside; all first cycles are due
  /// now.
  void start(Time now);

  /// Whether somebody wants the values of a point (index into Map::points). From the next cycle of its rate
  /// on the requests are as few as the wanted points need; a rate without wanted points makes none.
  void want(std::uint32_t point, bool wanted);
  /// A point at rest is not read, from the next cycle of its rate on.
  void rest(std::uint32_t point, bool at_rest);
  /// The point is at rest no more, and the next cycle of its rate is due as soon as none runs.
  void read_soon(std::uint32_t point);

  /// When select() has a request; in the past while a cycle runs. Time::max() if nothing is left to read.
  Time due() const;
  /// The cycle of one of the rates is late by a whole period.
  bool is_overdue(Time now) const;
  /// Chooses the request to make now: nullptr if none is due. It is current() until answered(), rejected() or
  /// give_up() is called.
  const ReadSpan* select(Time now);
  const ReadSpan& current() const { return step().span; }
  /// The last answer to current() was an exception, or there was none and it is set aside.
  bool failing() const { return step().last.has_value() || aside_.has(current()); }

  /// current() was answered, with values (nullopt) or with an exception that may pass. True if that is news:
  /// another answer than that of the cycle before, or the first one after it was set aside.
  bool answered(std::optional<modbus::Exception> exception, Time now);
  /// The device rejects current(): smaller requests take its place in this cycle. Returns the points that
  /// cannot be read at all and are given up until the next start().
  std::vector<std::uint32_t> rejected(Time now);
  /// The device does not know the function of current(): its points are given up until the next start().
  void give_up(Time now);

  /// current() ended the connection. Over the next one others are asked before it, if there are any.
  void ended_connection();
  /// It has not been by chance if it does so now: SetAside::is_suspected().
  bool is_suspected() const { return aside_.is_suspected(current()); }
  /// That was not because of current().
  void acquit() { aside_.answered(current()); }
  /// current() ended the connection again, though others were answered before, and after it over another one:
  /// it is parted as if it were rejected, and what is left is set aside. Returns those points; none if they
  /// were set aside before.
  std::vector<std::uint32_t> set_aside(Time now);

  /// The device may have other points, or other rights for this client: what was given up is asked for again,
  /// from the next cycle on, and what was rejected once more.
  void try_again();

  /// What was learned since the last call about requests that were rejected: each once.
  std::vector<RejectedRange> take_rejected_ranges();

  /// From its deadline to its last answer: the cycle that has ended since the last call, if one has.
  std::optional<Duration> take_cycle_time() { return std::exchange(cycle_time_, std::nullopt); }

  struct Status {
    double rate;             ///< Hz
    std::size_t requests;    ///< in a cycle, at the moment
    std::uint64_t overruns;  ///< deadlines that were left out
  };
  /// One for each rate, the fastest first.
  std::vector<Status> status() const;
  /// Of all rates.
  std::uint64_t overruns() const;

 private:
  struct Step {
    ReadSpan span;
    std::optional<modbus::Exception> last;
  };
  /// A request that was rejected and parted.
  struct Parted {
    Unreadable whole;
    std::optional<modbus::Range> hole;  ///< between the parts
  };
  struct Group {
    const plan::RateGroup* points;
    Schedule schedule;
    std::vector<Step> steps{};
    std::size_t next = 0;
    bool stale = false;            ///< to be planned anew when no cycle runs
    bool soon = false;             ///< then its next cycle is due at once
    bool joined_again = false;     ///< planned anew after what it learned: once is enough
    std::vector<Parted> parted{};  ///< in the cycle that runs
    std::uint64_t served = 0;      ///< the number of its last request

    bool idle() const { return steps.empty() || next == 0; }
    Time due() const;
  };
  const Step& step() const { return groups_[current_].steps[groups_[current_].next]; }
  Group* group_of(std::uint32_t point);
  void replan(Group& group, Time now);
  void remove_current();
  void done(Time now);
  void learn(Group& group);
  void ask_again(Span<const std::uint32_t> points);

  plan::Planner planner_;
  std::vector<bool> wanted_;    ///< by point
  std::vector<bool> given_up_;  ///< by point
  std::vector<bool> at_rest_;   ///< by point
  std::vector<Group> groups_;
  std::size_t current_ = 0;
  std::uint64_t requests_ = 0;
  bool others_first_ = false;                ///< a cycle has ended: the rates that wait have a turn
  std::vector<Unreadable> rejected_ranges_;  ///< no request of several points contains one
  std::vector<RejectedRange> findings_;
  SetAside aside_;
  std::vector<ReadSpan> deferred_;  ///< until another request is answered
  std::optional<Duration> cycle_time_;
};

}  // namespace coupler::host
