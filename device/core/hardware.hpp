// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tl/expected.hpp>

#include "common/modbus/exception.hpp"
#include "device/core/analogue_points.hpp"
#include "device/core/lines.hpp"

namespace coupler::node {

/// All the hardware of a map: lines behind bits, channels behind registers.
class Hardware {
 public:
  /// Both outlive it. `analogue` is null if no register has a channel.
  Hardware(Lines& lines, AnaloguePoints* analogue = nullptr) : lines_(&lines), analogue_(analogue) {}

  void take_edges(TimePoint now, EdgeSink& sink) { lines_->take_edges(now, sink); }

  /// Brings the image's cells of the range, which are `cells`, up to date. False if an input cannot be read.
  [[nodiscard]] bool read(Table table, modbus::Range range, Span<std::uint16_t> cells, TimePoint now) {
    if (table == Table::discrete_inputs) return lines_->read(range, cells, now);
    if (table == Table::input_registers && analogue_ != nullptr) return analogue_->read(range, now);
    return true;
  }

  /// Whether the range has an output. If so, a coil's level overwrites its element of `cells`; what a
  /// register is driven to is in the image.
  bool driven(Table table, modbus::Range range, Span<std::uint16_t> cells) const {
    if (table == Table::coils) return lines_->driven(range, cells);
    return analogue_ != nullptr && analogue_->has_output(range);
  }

  /// Drives the outputs of the range, all of them or none. Exceptions: AnaloguePoints::drive() 's.
  [[nodiscard]] tl::expected<void, modbus::Exception> drive(Table table, modbus::Range range,
                                                            Span<const std::uint16_t> next) {
    if (table == Table::holding_registers && analogue_ != nullptr) return analogue_->drive(range, next);
    if (table != Table::coils || lines_->drive(range, next)) return {};
    return tl::unexpected(modbus::Exception::server_device_failure);
  }

  /// Every output to its safe state. Tries all of them; false if one cannot be driven.
  [[nodiscard]] bool drive_safe() {
    const bool lines_are = lines_->drive_safe();
    const bool channels_are = analogue_ == nullptr || analogue_->drive_safe();
    return lines_are && channels_are;
  }

 private:
  Lines* lines_;
  AnaloguePoints* analogue_;
};

}  // namespace coupler::node
