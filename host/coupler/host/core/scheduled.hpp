// SPDX-License-Identifier: Apache-2.0
// Values that points are to have at a time, and what became of them.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

#include "coupler/host/core/stamp.hpp"
#include "coupler/host/core/write.hpp"
#include "coupler/modbus/changes.hpp"

namespace coupler::host {

/// So many may wait at a device, and last.
constexpr std::size_t max_scheduled = 64;

/// A write that is to be made at a time.
struct ScheduledWrite {
  Write write;
  Time due{};
  std::chrono::milliseconds duration{};  ///< then the point has its value from before again; 0: for good
  std::chrono::nanoseconds asked{};      ///< `due` as the caller said it: handed on
};

/// What is answered at once.
struct ScheduleAnswer {
  std::uint32_t number = 0;  ///< ScheduledOutcome has it, too; 0: refused
  std::string text;          ///< who does it, or why nobody does and what to do about it
};

/// What became of a write that was accepted. Each has exactly one outcome.
struct ScheduledOutcome {
  enum class Result : std::uint8_t {
    done = 1,   ///< carried out
    cancelled,  ///< not carried out, and it will not be
    failed,     ///< the device could not carry it out
    unknown     ///< the connection was lost, or the news of it, before it was known
  };

  std::uint32_t number = 0;
  std::uint32_t point = 0;  ///< index into Map::points
  Result result = Result::done;
  std::string reason{};              ///< empty when done
  std::chrono::nanoseconds asked{};  ///< ScheduledWrite's
  Time due{};
  Stamp at{};  ///< when it was carried out; otherwise when that was known

  /// When done, from the time that was asked for to `at`; otherwise 0.
  Duration lateness() const { return result == Result::done ? at.at - due : Duration::zero(); }
};

/// A write that was accepted.
struct AcceptedWrite {
  std::uint32_t number = 0;
  ScheduledWrite what;
  /// Another write to the point was carried out since: that one is the newer, or this one is cancelled.
  bool is_overwritten = false;
};

/// Gets the outcomes. Calls come from the connection's thread.
class ScheduledListener {
 public:
  virtual void on_outcome(const AcceptedWrite& which, ScheduledOutcome::Result result, Stamp at,
                          const std::string& reason) = 0;

 protected:
  ~ScheduledListener() = default;
};

/// Why its time or its duration is not possible, and what is; empty: they are. As a node has it.
std::string why_impossible(const ScheduledWrite& what, Time now);

/// In words. A node may have reasons that are not known here.
std::string to_string(modbus::Reason reason);

}  // namespace coupler::host
