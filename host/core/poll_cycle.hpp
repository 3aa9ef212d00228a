// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "host/core/error.hpp"
#include "host/core/read_plan.hpp"
#include "host/core/schedule.hpp"

namespace coupler::driver {

/// The read requests that are due together, and which of them is next. It learns, for the time of a
/// connection, what the device rejects.
class PollCycle {
 public:
  PollCycle(const Map& map, std::vector<ReadSpan> plan, Duration period);

  /// A new connection: everything is asked for again, the first cycle is due now.
  void start(Time now);

  /// When current() is to be requested; in the past inside a running cycle. Time::max() if nothing is left to
  /// read.
  Time due() const { return steps_.empty() ? Time::max() : schedule_.due(); }
  const ReadSpan& current() const { return steps_[next_].span; }
  /// The last answer to current() was an exception.
  bool failing() const { return steps_[next_].last.has_value(); }

  /// current() was answered, with values (nullopt) or with an exception that may pass. True if that is news:
  /// another answer than that of the cycle before.
  bool answered(std::optional<modbus::Exception> exception, Time now);

  /// The device does not know an address of current(): smaller requests take its place. A lone point is given
  /// up until the next start(): the result is then its index.
  std::optional<std::uint32_t> rejected(Time now);

  /// The device does not know the function of current(): its points are given up until the next start().
  void give_up(Time now);

  std::uint64_t overruns() const { return schedule_.overruns(); }

 private:
  struct Step {
    ReadSpan span;
    std::optional<modbus::Exception> last;
  };
  void advance_if_done(Time now);

  Map map_;
  std::vector<ReadSpan> plan_;
  Schedule schedule_;
  std::vector<Step> steps_;
  std::size_t next_ = 0;
};

}  // namespace coupler::driver
