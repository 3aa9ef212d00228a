// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "coupler/host/core/clock.hpp"
#include "coupler/host/core/stamp.hpp"
#include "coupler/modbus/node_time.hpp"

namespace coupler::host {

/// A request and its reply, each with the times at both ends.
struct Exchange {
  Time sent{};
  modbus::NodeTime arrived{};
  modbus::NodeTime replied{};
  Time received{};
};

/// Maps a node's clock to ours. The offset (ours minus the node's) is known to lie between two bounds: a
/// request does not arrive before it was sent, and a reply is not received before it was sent. Exchanges
/// that took long bound it loosely, and the best ones stay in force: a bound is kept until a newer one is
/// closer than what the drift since then has made of it.
///
/// It holds for two clocks that drift apart by at most `most_drift`, and whose drift changes by at most
/// `most_wander` from one measurement of it to the end of the next.
class ClockMapping {
 public:
  static constexpr double most_drift = 500e-6;
  static constexpr double most_wander = 20e-6;

  enum class Outcome {
    taken,    ///< where it contradicts what was known by a millisecond at most, the mapping begins with it
    jumped,   ///< it contradicts what was known: one of the clocks has jumped. The mapping begins with it
    refused,  ///< no two clocks can have these times; nothing is known any more
  };
  Outcome add(const Exchange& exchange);
  void forget();

  /// nullopt: nothing is known yet, or the time is none that such a clock can have.
  std::optional<Stamp> map(modbus::NodeTime at) const;
  /// The node's time that map() maps to `at`, as well as is known now; nullopt as above.
  std::optional<modbus::NodeTime> node_time(Time at) const;

 private:
  /// Between which two speeds the offset changes; nanoseconds a nanosecond.
  struct Drift {
    double least = -most_drift;
    double most = most_drift;
  };
  /// The least or most offset in nanoseconds, as of a node's time.
  struct Bound {
    modbus::NodeTime as_of{};
    double offset = 0;
  };
  /// Both, as of one time.
  struct Interval {
    modbus::NodeTime as_of{};
    double least = 0;
    double most = 0;
  };

  double least_at(modbus::NodeTime at) const;
  double most_at(modbus::NodeTime at) const;
  Interval interval_at(modbus::NodeTime at) const { return {at, least_at(at), most_at(at)}; }
  void begin(const Exchange& exchange);
  void measure_drift(modbus::NodeTime now);

  bool known_ = false;
  Bound least_;
  Bound most_;
  Drift drift_;
  Interval reference_;  ///< the drift is measured from here
  Time base_{};         ///< our time at base_node_: offsets are small numbers beside it
  modbus::NodeTime base_node_{};
};

}  // namespace coupler::host
