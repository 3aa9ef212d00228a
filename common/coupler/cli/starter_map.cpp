// SPDX-License-Identifier: Apache-2.0
#include "coupler/cli/starter_map.hpp"

#include <fmt/format.h>

namespace coupler::cli {
namespace {

constexpr std::string_view board_points = R"(mapping:
  coils:                                   # outputs: <name>/lamp and <name>/lamp/write are std_msgs/Bool
    lamp: {address: 0, line: GPIO17, safe: off, description: "on the cabinet"}
  discrete_inputs:                         # inputs; `gpioinfo` shows the lines of your board
    button: {address: 0, line: {chip: gpiochip0, offset: 27}, bias: pull_up, active_low: true, debounce: 5ms}
  input_registers:
    presses: {address: 0, type: UDINT, counter: {of: button, edge: rising}}   # counts while nobody looks
  holding_registers:
    setpoint: {address: 0, type: REAL, units: bar}   # plain memory: keeps what a client wrote
)";

constexpr std::string_view board_head = R"(
# Lines go to their safe state when the client that wrote them falls silent.
watchdog: {timeout: 1s}

)";

constexpr std::string_view coupler_points = R"(mapping:
  coils:                                   # outputs: <name>/valve and <name>/valve/write are std_msgs/Bool
    valve: {address: 0, description: "Y1, clamp"}
  discrete_inputs:                         # inputs
    door: 0                                # an address alone will do
  input_registers:                         # values of the device
    pressure: {address: 0, type: INT, scale: 0.01, units: bar}
  holding_registers:                       # values that can be written, too
    speed: {address: 0, type: UINT, units: rpm}
)";

constexpr std::string_view orders = R"(
# How wide values stand in registers. If a value is wild try `order: ABCD`, CDAB, BADC or DCBA at its point.
# Addresses are those on the wire, from 0. For the manual's numbers (40001 …) say: addressing: modicon
)";

std::string explained(const std::string& line, std::string_view comment) {
  return fmt::format("{:<40} # {}\n", line, comment);
}

}  // namespace

std::string starter_map(const Starter& starter) {
  std::string text = fmt::format("# yaml-language-server: $schema={}\n", starter.schema);
  text +=
      starter.node
          ? "# A board with GPIO lines. `coupler-node` serves it; `coupler-node … --sim` without a board.\n"
          : "# A Modbus/TCP coupler. `coupler_driver` makes each point a topic.\n";
  text += fmt::format("name: {}\n", starter.name);
  if (starter.node) return text + std::string(board_head) + std::string(board_points);
  text += fmt::format("address: {}\n", starter.address);
  text += explained("rate: 10", "polls a second");
  if (!starter.preset.empty())
    text += explained("preset: " + starter.preset, "what is true of all couplers of this kind");
  return text + std::string(orders) + "\n" + std::string(coupler_points);
}

}  // namespace coupler::cli
