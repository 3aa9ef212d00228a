// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coupler/host/core/error.hpp"
#include "coupler/host/core/poll_deadlines.hpp"
#include "coupler/host/core/unanswered_reads.hpp"
#include "coupler/map/table.hpp"
#include "coupler/modbus/range.hpp"
#include "coupler/plan/planner.hpp"

namespace coupler::host {

using plan::ReadSpan;

/// A read request that was rejected although its points can be read.
struct RejectedRange {
  Table table;
  modbus::Range range;
  bool between_points;  ///< true: no point needs these addresses; false: they can be read in parts, but not
                        ///< in one request
};

/// One line that says what it means for the map.
std::string to_string(const RejectedRange& rejected);

/// Chooses the next read request. The points of each rate have deadlines of their own. The cycle learns what
/// the device rejects, and forgets it at the end of the connection.
///
/// If several rates are due, the fastest goes first, so that a slow rate with many requests delays it by one
/// request at most. After a whole cycle of one rate each other rate that is due gets one request, so that
/// none starves.
class PollCycle {
 public:
  /// The storage of `map` must outlive the cycle. All points are wanted at first.
  explicit PollCycle(const Map& map);

  /// Makes it the cycle of a program that only looks, see Purpose. Call it before start().
  void only_look() { only_looks_ = true; }
  bool only_looks() const { return only_looks_; }

  /// Starts with a new connection. Everything is read again except what is set aside, and the first cycle of
  /// each rate is due now.
  void start(Time now);

  /// Leaves out these points from the next start() on. Requests for several other points do not include
  /// their addresses either.
  void leave_out(std::vector<std::uint32_t> points) { left_out_ = std::move(points); }
  /// Sets whether somebody wants the values of a point (index into Map::points). From the next cycle of its
  /// rate on only the requests are sent that the wanted points need, also for the power of ten of their
  /// scale.
  void want(std::uint32_t point, bool wanted);
  /// Stops reading a point from the next cycle of its rate on.
  void rest(std::uint32_t point, bool at_rest);
  /// Reads a point again that was at rest. The next cycle of its rate is due as soon as none runs.
  void read_soon(std::uint32_t point);

  /// The time at which select() has a request. It is in the past while a cycle runs, and Time::max() if
  /// nothing is left to read.
  Time due() const;
  /// Returns whether the cycle of a rate is late by a whole period.
  bool is_overdue(Time now) const;
  /// Chooses the request to send now; nullptr if none is due. It is current() until answered(), rejected() or
  /// give_up() is called.
  const ReadSpan* select(Time now);
  const ReadSpan& current() const { return step().span; }
  /// Returns whether the last reply to current() was an exception, or current() is set aside.
  bool failing() const { return step().last.has_value() || aside_.has(current()); }

  /// Notes that current() was answered with values (nullopt), or with an exception that may pass. Returns
  /// true if the reply differs from that in the cycle before, or is the first one after current() was set
  /// aside.
  bool answered(std::optional<modbus::Exception> exception, Time now);
  /// Notes that the device rejects current(). Smaller requests take its place in this cycle. Returns the
  /// points that cannot be read at all. They are not read until the next start(), unless only_look() was
  /// called.
  std::vector<std::uint32_t> rejected(Time now);
  /// Notes that the device answers current() with an exception that a single point may cause. Smaller
  /// requests take its place in this cycle. Returns the points that none of them reads. If there are no
  /// smaller requests, returns nullopt and changes nothing.
  std::optional<std::vector<std::uint32_t>> failed(Time now);
  /// Notes that the device does not know the function code of current(). Its points are not read until the
  /// next start().
  void give_up(Time now);

  /// Notes that current() ended the connection. Over the next connection other requests go before it, if
  /// there are any.
  void ended_connection();
  /// See UnansweredReads::is_suspected().
  bool is_suspected() const { return aside_.is_suspected(current()); }
  /// Notes that current() did not cause the end of the connection.
  void acquit() { aside_.answered(current()); }
  /// Notes that current() ended the connection again, although other requests were answered before it and,
  /// over another connection, after it. It is parted as if it were rejected, and what is left is set aside.
  /// Returns the points that were not set aside before.
  std::vector<std::uint32_t> set_aside(Time now);

  /// Reads again what was given up and what was rejected, from the next cycle on, because the device may have
  /// other points now, or other rights for this client.
  void try_again();

  /// Returns what was learned since the last call about rejected requests, each once.
  std::vector<RejectedRange> take_rejected_ranges();

  /// The time from deadline to last reply of the cycle that has ended since the last call, if one has.
  std::optional<Duration> take_cycle_time() { return std::exchange(cycle_time_, std::nullopt); }

  struct Status {
    double rate;             ///< Hz
    std::size_t requests;    ///< of a cycle as it is now
    std::uint64_t overruns;  ///< the number of deadlines that were left out
  };
  /// One element for each rate, the fastest first.
  std::vector<Status> status() const;
  /// The sum over all rates.
  std::uint64_t overruns() const;

 private:
  struct Step {
    ReadSpan span;
    std::optional<modbus::Exception> last;
    std::shared_ptr<const ReadSpan>
        part_of{};  ///< the failed request of which this step is a part in this cycle
  };
  /// A rejected request, and the parts that took its place.
  struct Parted {
    TableRange whole;
    std::optional<modbus::Range> hole;  ///< between the parts
  };
  struct Group {
    const plan::RateGroup* points;
    PollDeadlines deadlines;
    std::vector<Step> steps{};
    std::size_t next = 0;
    bool stale = false;            ///< has to be planned anew when no cycle runs
    bool has_parts = false;        ///< see Step::part_of
    bool soon = false;             ///< its next cycle is due at once after that
    bool joined_again = false;     ///< was planned anew after what it learned, which is done once
    std::vector<Parted> parted{};  ///< those of the cycle that runs
    std::uint64_t served = 0;      ///< the number of its last request

    bool idle() const { return steps.empty() || next == 0; }
    Time due() const;
  };
  /// The smaller requests for what current() reads.
  struct Parts {
    std::vector<ReadSpan> pieces{};
    std::vector<std::uint32_t> alone{};  ///< points that no smaller request reads
    std::optional<modbus::Range> hole{};
  };
  Parts parts_of_current() const;
  /// Replaces current() with its parts. With `keeps_alone`, a request for the points in `alone` stays in the
  /// cycle and counts as sent.
  void replace_current(const Parts& parts, bool keeps_alone);
  std::vector<std::uint32_t> part(bool keeps_alone, Time now);
  bool is_read(std::uint32_t point) const { return wanted_[point] && !given_up_[point]; }
  const Step& step() const { return groups_[current_].steps[groups_[current_].next]; }
  Group* group_of(std::uint32_t point);
  void replan(Group& group, Time now);
  void remove_current();
  void done(Time now);
  void learn(Group& group);
  static void join_parts(Group& group);
  void ask_again(Span<const std::uint32_t> points, bool soon = false);
  void give_up_left_out();

  plan::Planner planner_;
  bool only_looks_ = false;
  std::vector<std::uint32_t> left_out_{};
  std::vector<bool> wanted_;    ///< by point
  std::vector<bool> given_up_;  ///< by point
  std::vector<bool> at_rest_;   ///< by point
  std::vector<Group> groups_;
  std::size_t current_ = 0;
  std::uint64_t requests_ = 0;
  bool others_first_ = false;                ///< a cycle has ended, so the rates that wait get a request each
  std::vector<TableRange> rejected_ranges_;  ///< no request for several points contains one of these
  std::vector<RejectedRange> findings_;
  UnansweredReads aside_;
  std::vector<ReadSpan> deferred_;  ///< not sent until another request is answered
  std::optional<Duration> cycle_time_;
};

}  // namespace coupler::host
