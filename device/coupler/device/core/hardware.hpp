// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <tl/expected.hpp>

#include "coupler/device/core/analogue_points.hpp"
#include "coupler/device/core/hooks.hpp"
#include "coupler/device/core/lines.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler::device {

/// Why outputs were not driven.
struct DriveError {
  modbus::Exception exception;
  bool hardware_failed;  ///< false: the firmware's code, or the hardware, does not take the value
};

/// All that is behind the points of a map: lines behind bits, channels behind registers, a firmware's own
/// code.
class Hardware {
 public:
  /// All of them outlive it. `analogue` is null if no register has a channel, `hooked` if there is no code.
  Hardware(Lines& lines, AnaloguePoints* analogue = nullptr, HookedPoints* hooked = nullptr)
      : lines_(&lines), analogue_(analogue), hooked_(hooked) {}

  /// Takes what came by itself since the last call: edges, and values that the firmware has set.
  void take_news(TimePoint now, EdgeSink& sink, Changes& changes) {
    lines_->take_edges(now, sink);
    if (hooked_ != nullptr) hooked_->put_new_values(changes);
  }

  /// When news are to be taken again though nobody tells of them; nullopt: they are not.
  std::optional<TimePoint> next_change(TimePoint now) const { return lines_->next_change(now); }

  /// Lines::has_to_look().
  bool has_to_look() const { return lines_->has_to_look(); }

  /// Brings the image's cells of the range, which are `cells`, up to date. False if an input cannot be read.
  [[nodiscard]] bool read(Table table, modbus::Range range, Span<std::uint16_t> cells, TimePoint now) {
    if (table == Table::discrete_inputs) return lines_->read(range, cells, now);
    if (table == Table::input_registers && analogue_ != nullptr) return analogue_->read(range, now);
    return true;
  }

  /// Asks the firmware's code, if there is any, about the node, a request or a read.
  [[nodiscard]] bool shows_identity() const noexcept {
    return hooked_ == nullptr || hooked_->shows_identity();
  }
  [[nodiscard]] bool answers() const { return hooked_ == nullptr || hooked_->answers(); }
  [[nodiscard]] std::optional<modbus::Exception> refuse_read(Table table, modbus::Range range) const {
    return hooked_ == nullptr ? std::nullopt : hooked_->refuse_read(table, range);
  }

  /// See Hooks.
  [[nodiscard]] Span<const WantedOutput> take_wanted_outputs() {
    return hooked_ == nullptr ? Span<const WantedOutput>() : hooked_->take_wanted_outputs();
  }
  void not_driven(const WantedOutput& wanted, bool watchdog) { hooked_->not_driven(wanted, watchdog); }
  [[nodiscard]] bool hears_lines() const noexcept { return hooked_ != nullptr && hooked_->hears_lines(); }

  /// Lines::is_simulated(), Lines::pull().
  bool is_simulated() const { return lines_->is_simulated(); }
  [[nodiscard]] bool pull(modbus::Range inputs, Span<const std::uint16_t> levels) {
    return lines_->pull(inputs, levels);
  }

  /// Returns whether a firmware's code is behind points.
  bool has_code() const { return hooked_ != nullptr; }

  /// Returns whether the outputs of the range can be driven to the values in `next`, as far as that is known
  /// before it is tried. The firmware's code is not asked. Exceptions: 03 for a value that an output cannot
  /// take, 04 for hardware that is unplugged.
  [[nodiscard]] tl::expected<void, modbus::Exception> check(Table table, modbus::Range range,
                                                            Span<const std::uint16_t> next) const {
    if (table == Table::coils && !lines_->are_plugged(range))
      return tl::unexpected(modbus::Exception::server_device_failure);
    if (table == Table::holding_registers && analogue_ != nullptr) return analogue_->check(range, next);
    return {};
  }

  /// Returns whether the range contains an output. If so, a coil's level overwrites its element of `cells`;
  /// the value of a register output is in the image.
  bool driven(Table table, modbus::Range range, Span<std::uint16_t> cells) const {
    const bool hooked = hooked_ != nullptr && hooked_->has_output(table, range);
    if (table == Table::coils) return lines_->driven(range, cells) || hooked;
    return hooked || (analogue_ != nullptr && analogue_->has_output(range));
  }

  /// Drives the outputs of the range, all of them or none. Exceptions: AnaloguePoints::drive() 's; 04 if the
  /// firmware refuses, which is asked first, unless it wants this itself.
  [[nodiscard]] tl::expected<void, DriveError> drive(Table table, modbus::Range range,
                                                     Span<const std::uint16_t> next,
                                                     bool wanted_by_firmware = false) {
    if (hooked_ == nullptr || wanted_by_firmware) return drive_outputs(table, range, next);
    if (!hooked_->write(table, range, next))
      return tl::unexpected(DriveError{modbus::Exception::server_device_failure, false});
    const auto driven = drive_outputs(table, range, next);
    if (!driven) hooked_->take_back(table, range, next);
    return driven;
  }

  /// Drives the outputs of the range, each for itself: tries all of them, and overwrites in `next` those that
  /// cannot be driven with what the image has. What is unplugged is driven when it is plugged in again.
  /// False: there is one that cannot be driven.
  [[nodiscard]] bool drive_each(Table table, modbus::Range range, Span<std::uint16_t> next) {
    bool good = hooked_ == nullptr || hooked_->write_each(table, range, next);
    if (table == Table::holding_registers && analogue_ != nullptr) good &= analogue_->drive_each(range, next);
    if (table != Table::coils) return good;
    good &= lines_->drive_each(range, next);
    lines_->driven(range, next);
    return good;
  }

  /// Every output to its safe state. Tries all of them, a firmware's code last, which may take
  /// its time; false if one cannot be driven.
  [[nodiscard]] bool drive_safe() {
    const bool lines_are = lines_->drive_safe();
    const bool channels_are = analogue_ == nullptr || analogue_->drive_safe();
    if (hooked_ != nullptr) hooked_->make_safe();
    return lines_are && channels_are;
  }

 private:
  tl::expected<void, DriveError> drive_outputs(Table table, modbus::Range range,
                                               Span<const std::uint16_t> next) {
    constexpr auto failure = modbus::Exception::server_device_failure;
    if (table == Table::holding_registers && analogue_ != nullptr) {
      const auto driven = analogue_->drive(range, next);
      if (!driven) return tl::unexpected(DriveError{driven.error(), driven.error() == failure});
      return {};
    }
    if (table != Table::coils || lines_->drive(range, next)) return {};
    return tl::unexpected(DriveError{failure, true});
  }

  Lines* lines_;
  AnaloguePoints* analogue_;
  HookedPoints* hooked_;
};

}  // namespace coupler::device
