// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/device/node/serving_context.hpp"

namespace coupler::device {

/// The outputs of a map in parts, each with hardware of its own: groups of lines, and devices with analogue
/// outputs. What hangs for one part is no reason for another one not to be driven.
class OutputParts {
 public:
  /// The context is in force, and outlives it.
  explicit OutputParts(ServingContext& context);

  std::size_t size() const { return context_.wiring->output_groups() + devices_.size(); }
  /// Returns a text for the log: "gpiochip0 lines 5 (GPIO5), 6 (GPIO6)", "mcp4725 (setpoint, level)".
  std::string name(std::size_t part) const;
  /// Drives its outputs to their safe state. Tries all of them; false if one cannot be driven.
  [[nodiscard]] bool drive_safe(std::size_t part);
  /// Its hardware hangs: in this process, what needs it fails from now on.
  void give_up(std::size_t part);

 private:
  bool has_lines(std::size_t part) const { return part < context_.wiring->output_groups(); }
  template <class Use>
  void each_of_device(std::size_t part, Use use) const;

  ServingContext& context_;
  std::vector<std::string_view> devices_;  ///< as the map names them
};

}  // namespace coupler::device
