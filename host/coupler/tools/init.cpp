// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "coupler/base/starts_with.hpp"
#include "coupler/generate/output.hpp"
#include "coupler/map/loader/load.hpp"
#include "coupler/map/loader/preset.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/plan/explain.hpp"
#include "coupler/tools/commands.hpp"
#include "coupler/tools/output_argument.hpp"
#include "coupler/tools/report.hpp"
#include "coupler/tools/schema/schema.hpp"

namespace coupler::tools {
namespace {

constexpr auto schema_name = "map.schema.json";

/// The choices for a first map.
struct Starter {
  std::string name;     ///< of the device
  std::string address;  ///< of a coupler; empty: an example. A node has none in its map
  std::string preset;   ///< the coupler's kind; empty: any
  std::string addressing = "zero_based";
  bool node = false;   ///< a board with GPIO lines that coupler-node serves
  std::string schema;  ///< what an editor checks it with, as seen from the map's folder
};

constexpr std::string_view board_points = R"(mapping:
  coils:                                   # outputs: <name>/lamp and <name>/lamp/write are std_msgs/Bool
    lamp: {address: 0, line: GPIO17, safe: off, description: "on the cabinet"}
  discrete_inputs:                         # inputs; `gpioinfo` shows the lines of your board
    button: {address: 0, line: {chip: gpiochip0, offset: 27}, bias: pull_up, active_low: true, debounce: 5ms}
  input_registers:
    presses: {address: 0, type: UDINT, counter: {of: button, edge: rising}}   # counts between reads, too
  holding_registers:
    setpoint: {address: 0, type: REAL, units: bar}   # plain memory: keeps what a client wrote
    recipe: {address: 2, type: STRING, length: 16, order: AB}   # AB: other clients read its letters in sequence
)";

constexpr std::string_view board_head = R"(
# Lines go to their safe state when the client that wrote them falls silent.
watchdog: {timeout: 1s}

)";

constexpr std::string_view coupler_points = R"(mapping:
  coils:                                   # outputs: <name>/valve and <name>/valve/write are std_msgs/Bool
    valve: {address: 0, description: "Y1, clamp"}
  discrete_inputs:                         # inputs
    door: 0                                # an address alone is enough
  input_registers:                         # values of the device
    pressure: {address: 0, type: INT, scale: 0.01, units: bar}
  holding_registers:                       # values that can be written, too
    speed: {address: 0, type: UINT, units: rpm}
)";

constexpr std::string_view gripper_points = R"(
mapping:
  holding_registers:                       # what it is to do; only written
    action: {address: 0x03E8, type: UINT, access: write, values: {0: reset, 256: activate, 2304: move}}
    target: {address: 0x03E9, type: UINT, access: write, max: 255}   # 0 is open, 255 closed
    speed_and_force: {address: 0x03EA, type: UINT, access: write}    # speed * 256 + force, each up to 255
  input_registers:                         # what it does: <name>/state is std_msgs/UInt8
    state: {address: 0x07D0, type: USINT, offset: high}
    fault: {address: 0x07D1, type: USINT, offset: high}
    position: {address: 0x07D2, type: USINT, offset: high}
)";

constexpr std::string_view module_points = R"(
mapping:
  coils:                                   # outputs: <name>/valve and <name>/valve/write are std_msgs/Bool
    valve: {address: 0, description: "Y1, clamp"}
  discrete_inputs:                         # inputs
    door: 0                                # an address alone is enough
  holding_registers:                       # what switches an output: 0 writes, 1 its input
    valve_mode: {address: 0x1000, type: UINT, max: 3}
)";

/// A preset whose couplers are on a serial line, and points that they have.
struct SerialKind {
  std::string_view preset;
  std::string_view points;
};
constexpr SerialKind serial_kinds[] = {{"robotiq_2f", gripper_points}, {"waveshare_io_8ch", module_points}};

/// nullptr: it is none.
const SerialKind* serial_kind(std::string_view preset) {
  for (const SerialKind& kind : serial_kinds)
    if (kind.preset == preset) return &kind;
  return nullptr;
}

constexpr std::string_view orders = R"(
# How wide values stand in registers. If a value is absurd, try `order: ABCD`, CDAB, BADC or DCBA at its point.
)";

constexpr std::string_view zero_based =
    "# Addresses are zero-based. For the numbers of a manual (40001 ...), write: addressing: modicon\n";

/// Returns the line of a point with the number of a manual in place of its zero-based address.
std::string with_modicon_number(const std::string& line, Table table) {
  constexpr std::string_view key = "address: ";
  const std::size_t named = line.find(key);
  const std::size_t from = named == std::string::npos ? line.find(": ") + 2 : named + key.size();
  const std::size_t to = std::min(line.find_first_of(" ,}", from), line.size());
  const auto address = loader::parse_unsigned(line.substr(from, to - from));
  if (!address) return line;
  return line.substr(0, from) + plan::modicon(table, static_cast<std::uint32_t>(*address)) + line.substr(to);
}

std::string with_modicon_numbers(std::string_view points) {
  std::string text;
  std::optional<Table> table;
  std::istringstream lines{std::string(points)};
  for (std::string line; std::getline(lines, line);) {
    std::optional<Table> begins;
    for (const Table each : tables)
      if (starts_with(line, fmt::format("  {}:", to_string(each)))) begins = each;
    text += (begins || !table ? line : with_modicon_number(line, *table)) + '\n';
    if (begins) table = begins;
  }
  return text;
}

std::string explained(const std::string& line, std::string_view comment) {
  return fmt::format("{:<40} # {}\n", line, comment);
}

/// A map with an example of what people need first, each line explained. It passes `coupler check`.
std::string starter_map(const Starter& starter) {
  const SerialKind* serial = serial_kind(starter.preset);
  const bool has_address = serial == nullptr || !starter.address.empty();
  std::string text = fmt::format("# yaml-language-server: $schema={}\n", starter.schema);
  if (starter.node)
    text += "# A board with GPIO lines. `coupler-node` serves it; `coupler-node … --sim` without a board.\n";
  else
    text += fmt::format("# A {} coupler. `coupler_driver` makes each point a topic.\n",
                        has_address ? "Modbus/TCP" : "Modbus RTU");
  const bool is_modicon = starter.addressing == "modicon";
  const auto numbered = [&](std::string_view points) {
    return is_modicon ? with_modicon_numbers(points) : std::string(points);
  };
  text += fmt::format("name: {}\n", starter.name);
  if (is_modicon) text += explained("addressing: modicon", "addresses are the numbers of manuals: 40001 ...");
  if (starter.node) {
    text +=
        explained("port: 1502", "502, the standard port, needs a privilege; the package's service has it");
    text += explained("wordorder_reverse: true",
                      "wide values stand as `order: ABCD`, which most Modbus clients expect");
    return text + std::string(board_head) + numbered(board_points);
  }
  if (has_address)
    text += fmt::format("address: {}\n", starter.address.empty() ? "192.168.1.17" : starter.address);
  else
    text += explained("serial: {device: /dev/ttyUSB0}", "best by its name in /dev/serial/by-id");
  text += explained("rate: 10", "polls a second");
  if (!starter.preset.empty())
    text += explained("preset: " + starter.preset, "what is true of all couplers of this kind");
  if (serial != nullptr) return text + numbered(serial->points);
  return text + std::string(orders) + (is_modicon ? "" : std::string(zero_based)) + "\n" +
         numbered(coupler_points);
}

struct Arguments {
  Starter starter{"device", {}, {}, "zero_based", false, schema_name};
  std::string out;
  bool force = false;
};

Exit init(const Arguments& given) {
  Arguments arguments = given;
  if (const auto preset = loader::preset_of_model(given.starter.preset); !preset.empty())
    arguments.starter.preset = preset;
  const bool to_file = arguments.out != standard_output;
  const std::filesystem::path map =
      names_no_file(arguments.out) ? arguments.starter.name + ".yaml" : arguments.out;
  if (to_file)
    if (const auto can = can_make(map.string(), arguments.force); !can) return complain("init", can.error());
  const std::string text = starter_map(arguments.starter);
  const LoadResult loaded = load_map(text, map.string());
  if (!loaded.map) {  // the name, the address or the preset
    print(loaded.diagnostics);
    return bad_input;
  }
  if (!to_file) return write_out("init", arguments.out, text);
  for (const auto& [path, content] :
       {std::pair(map, text), std::pair(map.parent_path() / schema_name, schema::map_schema())}) {
    const auto outcome = generate::write_if_changed(path, content);
    if (!outcome)
      return complain("init", bad_call, outcome.error(), "name a file that you may write with --out");
    fmt::print("{}: {}\n", path.string(), *outcome == generate::Outcome::written ? "written" : "unchanged");
  }
  fmt::print("Next: change its points, then `coupler check {}`\n", map.string());
  return ok;
}

}  // namespace

void add_init(Program& program, Exit& exit) {
  auto command = program.add_command(
      "init", "Write a first map, with comments, and beside it the schema that editors check it with.");
  const auto arguments = std::make_shared<Arguments>();
  command.add_option("NAME", arguments->starter.name, "Name of the device: its topics are NAME/POINT")
      .type_name("");
  auto address = command.add_option("--address", arguments->starter.address, "Host name or IP address")
                     .type_name("HOST");
  auto preset =
      command
          .add_option("--preset", arguments->starter.preset,
                      "The coupler's kind: wago_750, beckhoff_bk9000, moxa_e1200 or plc; on a "
                      "serial line robotiq_2f or waveshare_io_8ch; or its model number, such as 750-352")
          .type_name("PRESET");
  command
      .add_option("--addressing", arguments->starter.addressing,
                  "How addresses are written: zero_based, or modicon as in most manuals (40001 ...)")
      .one_of({"zero_based", "modicon"});
  command.add_flag("--node", arguments->starter.node, "For a board with GPIO lines, served by coupler-node")
      .excludes(address)
      .excludes(preset);
  command
      .add_option("--out", arguments->out,
                  "The map's file (default: NAME.yaml); - is standard output, without the schema")
      .type_name("FILE");
  command.add_flag("--force", arguments->force, "Replace an existing map");
  command.footer(
      "Example:\n  coupler init press --preset wago_750 --address 192.168.1.17\n  coupler init cell --node");
  command.callback([arguments, &exit] { exit = init(*arguments); });
}

}  // namespace coupler::tools
