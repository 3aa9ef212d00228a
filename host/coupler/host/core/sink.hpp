// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/base/span.hpp"
#include "coupler/host/core/scheduled.hpp"
#include "coupler/host/core/stamp.hpp"
#include "coupler/plan/read_span.hpp"

namespace coupler::host {

using plan::ReadSpan;

enum class Level { info, warning, error };

/// Receives what a device reads and reports. The connection's thread makes the calls, and they delay its next
/// request. Only on_report() may also be called by a thread that writes.
class Sink {
 public:
  virtual ~Sink() = default;
  /// `bits[i]` is the coil or discrete input `span.range.start() + i`, as it was at `stamp`.
  virtual void on_bits(const ReadSpan& span, Span<const std::uint8_t> bits, Stamp stamp) = 0;
  /// `registers[i]` is the register `span.range.start() + i`, as it was at `stamp`.
  virtual void on_registers(const ReadSpan& span, Span<const std::uint16_t> registers, Stamp stamp) = 0;
  /// The time at which the point's value is wanted again even if it has not changed: `max_interval` after it
  /// was published last. Time::max() if there is none.
  virtual Time repeat_at(std::uint32_t /*point*/) const { return Time::max(); }
  /// Says whether the device is a node of this project, if that was asked, before the device is online.
  virtual void on_identified(bool /*is_node*/) {}
  /// Says that the device answers, or no longer answers. It is called at each change. A device begins
  /// offline.
  virtual void on_online(bool online) = 0;
  /// Says why the device does not answer, if that is new. It is also reported.
  virtual void on_loss(const std::string& /*why*/) {}
  virtual void on_report(Level level, const std::string& text) = 0;
  /// Says what became of a scheduled write.
  virtual void on_scheduled(const ScheduledOutcome& /*outcome*/) {}
};

}  // namespace coupler::host
