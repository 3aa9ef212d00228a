// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/base/span.hpp"
#include "coupler/host/core/identity_check.hpp"
#include "coupler/host/core/scheduled.hpp"
#include "coupler/host/core/stamp.hpp"

namespace coupler::host {

enum class Level { info, warning, error };

/// Receives what a device reads and reports. The connection's thread makes the calls, and they delay its next
/// request. Only on_report() may also be called by a thread that writes.
class Sink {
 public:
  virtual ~Sink() = default;
  /// Says that the device's ValueTable has new values of these points (indices into Map::points). They may
  /// equal those before: see ValueTable::differs().
  virtual void on_values(Span<const std::uint32_t> points) = 0;
  /// Says that the table has a new value of this point, because the node has announced a change.
  virtual void on_told(std::uint32_t point) { on_values({&point, 1}); }
  /// Says that the node has lost changes: nothing is known of the announced points between their last values
  /// and the next ones.
  virtual void on_gap() {}
  /// Says that these points could not be read, or that what was read is no value. The table has the exception
  /// or the reason. It may be called again for each attempt.
  virtual void on_no_values(Span<const std::uint32_t> /*points*/, Time /*at*/) {}
  /// The time at which the point's value is wanted again even if it has not changed: `max_interval` after it
  /// was published last. Time::max() if there is none.
  virtual Time repeat_at(std::uint32_t /*point*/) const { return Time::max(); }
  /// Says that a cycle has ended: all points that are read at one rate have been asked for once.
  virtual void on_cycle() {}
  /// Says how the device's map compares with the driver's. It is called, before
  /// on_online(true), at each connect at which the device answers the question for its identity.
  virtual void on_identified(Identity::Verdict /*verdict*/) {}
  /// Says that the device answers, or no longer answers. It is called at each change. A device begins
  /// offline.
  virtual void on_online(bool online) = 0;
  /// Says why the device does not answer, if that is new. It is also reported.
  virtual void on_loss(const std::string& /*why*/) {}
  /// Gives the error that ended a connection or an attempt to connect.
  virtual void on_failure(const Error& /*error*/) {}
  virtual void on_report(Level level, const std::string& text) = 0;
  /// Reports a fact about the device that holds while the connection lasts.
  virtual void on_note(Level level, const std::string& text) { on_report(level, text); }
  /// Says what became of a scheduled write.
  virtual void on_scheduled(const ScheduledOutcome& /*outcome*/) {}
};

}  // namespace coupler::host
