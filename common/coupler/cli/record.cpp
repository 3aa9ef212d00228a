// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "coupler/cli/commands.hpp"
#include "coupler/cli/device_argument.hpp"
#include "coupler/cli/live_device.hpp"

namespace coupler::cli {
namespace {

struct Arguments {
  DeviceArgument device;
  std::string out;
  std::string keep = "1G";
  bool csv = false;
  bool sync = false;
};

/// "500M"; the letter is one of K, M, G and T, of 1024 each.
std::optional<std::uint64_t> parse_size(std::string_view text) {
  std::uint64_t size = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), size);
  const std::string_view letter = text.substr(static_cast<std::size_t>(end - text.data()));
  constexpr std::string_view letters = "KMGT";
  if (error != std::errc() || letter.size() > 1) return std::nullopt;
  if (letter.empty()) return size;
  const std::size_t power = letters.find(letter);
  const std::size_t shift = 10 * (power + 1);
  if (power == std::string_view::npos || size > UINT64_MAX >> shift) return std::nullopt;
  return size << shift;
}

Exit run(const Arguments& arguments) {
  const auto device = get_device("record", arguments.device);
  if (!device) return device.error();
  RecordOptions options;
  options.csv = arguments.csv;
  options.sync = arguments.sync;
  options.file = arguments.out;
  if (options.file.empty()) {
    options.file = std::string(device->map.name) + (arguments.csv ? ".csv" : ".jsonl");
    std::replace(options.file.begin(), options.file.end(), '/', '_');  // a namespace of ROS
  }
  constexpr std::uint64_t least = 1 << 20;
  const auto keep = parse_size(arguments.keep);
  if (!keep || *keep < least)
    return complain("record", bad_call, "--keep: '" + arguments.keep + "' is no size of 1M or more",
                    "give one as 500M or 20G");
  options.keep = *keep;
  return record(device->map, options);
}

}  // namespace

void add_record(Program& program, Exit& exit) {
  auto command = program.add_command(
      "record",
      "Write every change of a device's points to a file, with its time, until Ctrl-C. Never writes to it.");
  const auto arguments = std::make_shared<Arguments>();
  arguments->device.may_be_unknown = true;
  add_device_options(command, arguments->device);
  command
      .add_option("-o,--out", arguments->out,
                  "The file; - is standard output. Default: the map's name and .jsonl. One that is there is "
                  "kept, as NAME.1.jsonl")
      .type_name("FILE");
  command.add_flag("--csv", arguments->csv,
                   "Comma-separated values, for spreadsheets; they cannot be played");
  command
      .add_option("--keep", arguments->keep,
                  "Delete the oldest files of this recording when all have so much")
      .show_default()
      .type_name("SIZE");
  command.add_flag("--sync", arguments->sync,
                   "After each write wait until the disk has it, for machines that lose their power");
  command.footer(
      "Example:\n  coupler record press.yaml -o press.jsonl\n"
      "To play it: coupler-node --sim --replay press.jsonl\n"
      "Exit status 3: the device was never reached, or what came last could not be written.");
  command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace coupler::cli
