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

/// Gets what a device reads and reports. Calls come from the connection's thread, and delay its next request.
/// Only on_report() may also come from a thread that writes.
class Sink {
 public:
  virtual ~Sink() = default;
  /// `bits[i]` is the coil or discrete input `span.range.start() + i`, as it was at `stamp`.
  virtual void on_bits(const ReadSpan& span, Span<const std::uint8_t> bits, Stamp stamp) = 0;
  /// `registers[i]` is the register `span.range.start() + i`, as it was at `stamp`.
  virtual void on_registers(const ReadSpan& span, Span<const std::uint16_t> registers, Stamp stamp) = 0;
  /// When the point's value is wanted once more though it is still the same: `max_interval` after it was
  /// published last. Time::max(): never.
  virtual Time repeat_at(std::uint32_t /*point*/) const { return Time::max(); }
  /// Whether the device is a node of this project, where that is asked, before it is online.
  virtual void on_identified(bool /*is_node*/) {}
  /// The device answers (or no longer does). Only changes; it begins offline.
  virtual void on_online(bool online) = 0;
  /// Why it does not answer; reported, too. Only what is new.
  virtual void on_loss(const std::string& /*why*/) {}
  virtual void on_report(Level level, const std::string& text) = 0;
  /// What became of a write at a time.
  virtual void on_scheduled(const ScheduledOutcome& /*outcome*/) {}
};

}  // namespace coupler::host
