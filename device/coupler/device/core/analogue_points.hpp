// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tl/expected.hpp>

#include "coupler/device/core/channels.hpp"
#include "coupler/device/core/image.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler::device {

/// Registers with a channel behind them: what of the image comes from the hardware, and what goes there. The
/// image holds what the outputs are driven to.
class AnaloguePoints {
 public:
  /// All of them outlive it.
  AnaloguePoints(const Map& map, Image& image, Channels& channels)
      : map_(map), image_(image), channels_(channels) {}

  /// Brings the input registers of the range that have a channel up to date. False if one cannot be read.
  [[nodiscard]] bool read(modbus::Range inputs, TimePoint now);

  /// Drives the outputs that have a register in the range, none of them in part, to what `next` says: one
  /// element for each address of the range. Exceptions: 03 a value that an output cannot take, 04 one that
  /// cannot be driven; then all of them are at the values that the image has.
  [[nodiscard]] tl::expected<void, modbus::Exception> drive(modbus::Range holding,
                                                            Span<const std::uint16_t> next);

  /// The same, each for itself: overwrites in `next` those that cannot be driven with what the image has. One
  /// that is unplugged counts as driven: it has to come back so. False: there is one.
  [[nodiscard]] bool drive_each(modbus::Range holding, Span<std::uint16_t> next);

  /// Returns whether drive() could succeed, as far as that is known before it is tried.
  [[nodiscard]] tl::expected<void, modbus::Exception> check(modbus::Range holding,
                                                            Span<const std::uint16_t> next) const;

  /// Returns whether the range contains a register of an output.
  bool has_output(modbus::Range holding) const;

  /// Drives every output as drive() does one. Tries all of them; false if one cannot be driven.
  [[nodiscard]] bool drive_all(bool safe);

  /// Drives one output to its safe state, if `safe`, or else to what the image says. False if it cannot be.
  [[nodiscard]] bool drive(const Point& output, bool safe);

  /// Drives every output to its safe state (`hold` stays), and the image shows it. Tries all of them; false
  /// if one cannot be driven.
  [[nodiscard]] bool drive_safe();

 private:
  bool accepts(modbus::Range holding, Span<const std::uint16_t> next) const;
  /// The outputs of the range that come before `end`.
  void restore(modbus::Range holding, const Point& end);

  const Map& map_;
  Image& image_;
  Channels& channels_;
};

/// The value of an output's safe state, which is not Safe::hold. `off` is 0 % for a PWM, register value 0 for
/// others.
double safe_value_of(const Point& output);

}  // namespace coupler::device
