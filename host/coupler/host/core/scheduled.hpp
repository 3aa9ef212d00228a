// SPDX-License-Identifier: Apache-2.0
// Scheduled writes and their outcomes.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "coupler/host/core/stamp.hpp"
#include "coupler/host/core/write.hpp"
#include "coupler/modbus/changes.hpp"

namespace coupler::host {

/// The limit of scheduled writes that may wait or last at a device.
constexpr std::size_t max_scheduled = 64;

/// A write that is to be made at a given time.
struct ScheduledWrite {
  Write write;
  Time due{};
  std::chrono::milliseconds duration{};  ///< after it the point has its former value again; 0: for good
  std::chrono::nanoseconds asked{};      ///< `due` as the caller said it, to be passed on
  Duration may_be_late{};   ///< it is made at once if its time has passed by no more than this; 0: it is
                            ///< refused then
  std::uint64_t owner = 0;  ///< who has scheduled it, for WritesFrom; 0: nobody in particular
};

/// The scheduled writes of some points that are due at a time or later, and that an owner has scheduled.
struct WritesFrom {
  std::vector<std::uint32_t> points;  ///< indexes into Map::points
  Time from{};
  std::uint64_t owner = 0;  ///< 0: whoever has

  bool has(const ScheduledWrite& what) const;
};

/// The answer to a call, at once.
struct ScheduleAnswer {
  std::uint32_t number = 0;  ///< the number that ScheduledOutcome has, too; 0: refused
  std::string text;          ///< who does it; or why it is refused, and what to do
  bool by_device = false;    ///< a timer of the device does it
  bool is_full = false;      ///< it is refused because too many wait; there is room when one of them is over
};

/// The outcome of a write that was accepted. Each has exactly one.
struct ScheduledOutcome {
  enum class Result : std::uint8_t {
    done = 1,   ///< carried out
    cancelled,  ///< not carried out, and will not be
    failed,     ///< the device could not carry it out
    unknown     ///< the connection, or the report of the outcome, was lost
  };

  std::uint32_t number = 0;
  std::uint32_t point = 0;  ///< index into Map::points
  Result result = Result::done;
  std::string reason{};              ///< empty if `done`
  std::chrono::nanoseconds asked{};  ///< see ScheduledWrite
  Time due{};
  Stamp at{};  ///< the time at which it was carried out, or at which its outcome was known

  /// The delay from the time that was asked for to `at` if `done`; otherwise 0.
  Duration lateness() const { return result == Result::done ? at.at - due : Duration::zero(); }
};

/// A write that was accepted.
struct AcceptedWrite {
  std::uint32_t number = 0;
  ScheduledWrite what;
  /// Returns whether another write to the point was carried out since: then that one is newer, or this one is
  /// cancelled.
  bool is_overwritten = false;
};

/// An accepted write without an outcome.
struct WaitingWrite {
  AcceptedWrite which;
  bool by_device = false;  ///< a timer of the device does it, not the driver's
};

/// Receives the outcomes. The connection's thread makes the calls.
class ScheduledListener {
 public:
  virtual void on_outcome(const AcceptedWrite& which, ScheduledOutcome::Result result, Stamp at,
                          const std::string& reason) = 0;

 protected:
  ~ScheduledListener() = default;
};

/// Returns why the time or the duration is impossible, and what is possible; empty if they are possible. The
/// rules are those of a node.
std::string why_impossible(const ScheduledWrite& what, Time now);

/// Returns a text. A node may have reasons that are not known here.
std::string to_string(modbus::Reason reason);

}  // namespace coupler::host
