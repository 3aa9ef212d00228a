// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "coupler/device/core/change_ring.hpp"
#include "coupler/device/core/client_changes.hpp"
#include "coupler/device/core/client_session.hpp"
#include "coupler/device/core/image.hpp"
#include "coupler/device/core/output_schedule.hpp"
#include "coupler/device/core/rights.hpp"
#include "coupler/device/core/time.hpp"

namespace coupler::device {

/// Finds out which coils and discrete inputs change, whatever the cause, and tells clients that wait for it.
/// It knows the level of each bit that was told last; a bit that is given the level it has is no change.
class Changes final : public ScheduleSink {
 public:
  /// Nothing is told.
  Changes() = default;
  /// `told` has an element for each of the image's bits. All of them outlive it. Nothing is told before
  /// begin().
  Changes(const Image& image, Span<ChangeRing::Entry> ring, Span<std::uint16_t> told)
      : image_(&image), ring_(ring), told_(told) {}

  /// From now on changes are told: those from what the image holds now.
  void begin(std::uint32_t epoch);
  bool are_told() const { return ring_.epoch() != 0; }
  const ChangeRing& ring() const { return ring_; }

  /// When what happens from now on happens, unless it comes with a time of its own.
  void set_time(TimePoint now) { now_ = now; }
  /// Bits of the range may have changed. Those of a table of registers are none.
  void compare(Table table, modbus::Range range);
  /// Any bit may have changed.
  void compare_all();
  /// A discrete input has this level since that time; the image shows it.
  void set_level(std::uint16_t input, bool level, TimePoint at);
  /// Returns whether bits of the range have another level than the one that was told last.
  bool differs(Table table, modbus::Range range) const;
  /// Something else that is told to whoever waits.
  void add_outcome(const modbus::Change& outcome, const ClientSession* owner) override;
  /// At least so many changes of bits were not seen.
  void lose(std::uint32_t count);

  /// Returns whether the session's wait has to be answered now, because there is something to tell it or its
  /// time is over.
  bool is_due(ClientSession& session, const Rights& rights, TimePoint now) const {
    return now >= session.wait->until || ClientChanges(ring_, rights, session).has_news();
  }
  /// Writes the reply PDU that is sent now into `pdu` (at least max_pdu_size bytes); returns its size.
  std::size_t reply_to(ClientSession& session, const Rights& rights, TimePoint now,
                       Span<std::uint8_t> pdu) const;

 private:
  Span<std::uint16_t> told(Span<const std::uint16_t> cells) const;
  void tell(Table table, std::uint32_t address, std::uint16_t level, TimePoint at);

  const Image* image_ = nullptr;
  ChangeRing ring_;
  Span<std::uint16_t> told_;  ///< in the order of the image's cells
  TimePoint now_{};
};

}  // namespace coupler::device
