// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "coupler/host/core/clock.hpp"
#include "coupler/host/core/stamp.hpp"
#include "coupler/modbus/node_time.hpp"

namespace coupler::host {

/// The times of a request and its reply at both ends.
struct Exchange {
  Time sent{};
  modbus::NodeTime arrived{};
  modbus::NodeTime replied{};
  Time received{};
};

/// Maps a node's clock to ours. The offset (ours minus the node's) lies between two bounds, because a request
/// does not arrive before it was sent, and a reply is not received before it was sent. An exchange that took
/// long gives loose bounds. A bound is kept until a newer one is closer than the old one has become by drift.
///
/// The mapping is right for two clocks that drift apart by at most `most_drift`, if the drift changes by at
/// most `most_wander` from one measurement of it to the end of the next.
class ClockMapping {
 public:
  static constexpr double most_drift = 500e-6;
  static constexpr double most_wander = 20e-6;

  enum class Outcome {
    taken,    ///< the exchange was used; if it contradicts the mapping by a millisecond at most, the mapping
              ///< begins anew with it
    jumped,   ///< the exchange contradicts the mapping, so one of the clocks has jumped; the mapping begins
              ///< anew with it
    refused,  ///< no two clocks can have these times, and the mapping is empty now
  };
  Outcome add(const Exchange& exchange);
  void forget();

  /// Returns nullopt if nothing is known yet, or if such a clock cannot have this time.
  std::optional<Stamp> map(modbus::NodeTime at) const;
  /// Returns the node's time that map() maps to `at`, as well as it is known now; nullopt as above.
  std::optional<modbus::NodeTime> node_time(Time at) const;

 private:
  /// The two speeds between which the offset changes, in nanoseconds for each nanosecond.
  struct Drift {
    double least = -most_drift;
    double most = most_drift;
  };
  /// The least or the greatest offset in nanoseconds, at a time of the node.
  struct Bound {
    modbus::NodeTime as_of{};
    double offset = 0;
  };
  /// Both bounds at one time.
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
  Time base_{};         ///< our time at base_node_, beside which offsets are small numbers
  modbus::NodeTime base_node_{};
};

}  // namespace coupler::host
