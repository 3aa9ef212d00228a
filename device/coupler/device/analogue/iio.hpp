// SPDX-License-Identifier: Apache-2.0
// Channels of Linux's Industrial I/O by their files, as the kernel's Documentation/ABI/testing/sysfs-bus-iio
// says: physical = (raw + offset) × scale. Why without libiio: docs/decisions/0008-iio-without-libiio.md.
#pragma once

#include <string>
#include <tl/expected.hpp>

#include "coupler/device/analogue/attribute.hpp"
#include "coupler/map/hardware.hpp"

namespace coupler::device {

/// An ADC or sensor.
struct IioInput {
  std::string device;  ///< "iio:device0"
  std::string name;    ///< for the log: "iio:device0 (adc) input voltage0"
  Attribute file;
  double gain = 1;
  double offset = 0;

  /// V, A, °C …; the error is an errno. Takes as long as the conversion.
  tl::expected<double, int> read() const;
};

/// A DAC.
struct IioOutput {
  std::string device;
  std::string name;
  Attribute file;
  double gain = 1;
  double offset = 0;
  double least = 0;  ///< raw
  double most = 0;

  /// Returns whether the channel has a raw value for it, as far as the channel tells.
  bool accepts(double value) const;
  /// Returns 0 or an errno.
  [[nodiscard]] int drive(double value) const;
};

/// Find the channel below `sysfs` (usually "/sys"). The error says what is there instead, and the remedy.
tl::expected<IioInput, std::string> open_iio_input(const std::string& sysfs, const Iio& wanted);
tl::expected<IioOutput, std::string> open_iio_output(const std::string& sysfs, const Iio& wanted);

}  // namespace coupler::device
