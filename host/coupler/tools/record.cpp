// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "coupler/base/never_wait.hpp"
#include "coupler/host/core/clock.hpp"
#include "coupler/host/core/device_thread.hpp"
#include "coupler/host/modbus/make_links.hpp"
#include "coupler/host/record/record_thread.hpp"
#include "coupler/map/loader/load.hpp"
#include "coupler/map/node_address.hpp"
#include "coupler/tools/commands.hpp"
#include "coupler/tools/device_argument.hpp"
#include "coupler/tools/interruption.hpp"
#include "coupler/tools/output_argument.hpp"
#include "coupler/tools/read_only_map.hpp"
#include "coupler/tools/report_line.hpp"

namespace coupler::tools {
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

constexpr std::chrono::seconds progress_period{1};

/// A terminal that has gone, or a full disk behind it, ends no recording.
void show(const std::string& text) { std::fputs(text.c_str(), stderr); }

void say(host::Level level, const std::string& text) {
  show((::isatty(STDERR_FILENO) == 1 ? "\r\x1b[K" : "") + report_line("record", level, text));
}

std::string size_text(std::uint64_t bytes) {
  constexpr double mega = 1 << 20;
  return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / mega);
}

std::string progress_text(const host::Recorder::Counts& counts, std::size_t points,
                          const host::RecordThread& file, host::Duration since_start) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(since_start).count();
  return fmt::format("{}:{:02}:{:02}  {}  {} of {} points have a value  {} changes  {}", seconds / 3600,
                     seconds / 60 % 60, seconds % 60, counts.online ? "online" : "offline", counts.good,
                     points, counts.changes, size_text(file.written()));
}

/// "device.jsonl": of the map of that name.
std::string usual_file(const Map& map, bool csv) {
  std::string file = std::string(map.name) + (csv ? ".csv" : ".jsonl");
  std::replace(file.begin(), file.end(), '/', '_');  // a namespace of ROS
  return file;
}

/// Records every change of the device at `original.connection` until an ending signal (see Interruption).
Exit record(const Map& original, host::RecordFile file, bool csv) {
  const ReadOnlyMap looking(original);
  const Map& map = looking.map();
  host::Link link = host::make_link(map.connection, map.limits);
  never_wait_for_reader_of(STDERR_FILENO);
  if (file.path() != standard_output)
    std::signal(SIGPIPE, SIG_IGN);  // a recording outlives the reader of its messages
  const host::Clock& clock = link.clock();
  host::SteadyClock pause;
  std::atomic<bool> stopped{false};
  const auto format = csv ? host::csv_format() : host::json_format();
  const host::Time start = clock.now();
  host::ValueTable values(map);
  host::Recorder recorder(map, values, node_address_text(map.connection), *format, start,
                          [&](host::Level level, const std::string& text) {
                            if (!stopped) say(level, text);
                          });
  const Interruption interruption([&] {
    stopped = true;
    recorder.end_comes();
    pause.stop();
  });
  if (const std::string_view warning = watchdog_warning(original); !warning.empty())
    say(host::Level::warning, std::string(warning));
  host::RecordThread writing(recorder, std::move(file), say);
  host::DeviceThread device(map, map.verify, load_served_map, link, values, recorder);
  device.start();

  const auto progress = [&](const host::Recorder::Counts& counts) {
    return progress_text(counts, map.points.size(), writing, clock.now() - start);
  };
  while (!stopped) {
    pause.sleep_until(clock.now() + progress_period);
    if (::isatty(STDERR_FILENO) == 1 && !stopped) show("\r\x1b[K" + progress(recorder.counts()));
  }
  device.end();
  const host::Recorder::Counts counts = recorder.counts();
  const bool is_whole = writing.end();
  say(host::Level::info, fmt::format("{}: {}", writing.path().string(), progress(counts)));
  return counts.was_online && is_whole ? ok : failed;
}

Exit run(const Arguments& arguments) {
  const auto device = get_device("record", arguments.device);
  if (!device) return device.error();
  constexpr std::uint64_t least = 1 << 20;
  const auto keep = parse_size(arguments.keep);
  if (!keep || *keep < least)
    return complain("record", bad_call, "--keep: '" + arguments.keep + "' is no size of 1M or more",
                    "give one as 500M or 20G");
  const std::string path = arguments.out.empty() ? usual_file(device->map, arguments.csv) : arguments.out;
  auto file = path == standard_output ? host::RecordFile::standard_output()
                                      : host::RecordFile::open(path, {*keep, arguments.sync});
  if (!file) return complain("record", bad_call, file.error(), {});
  return record(device->map, *std::move(file), arguments.csv);
}

}  // namespace

void add_record(Program& program, Exit& exit) {
  auto command = program.add_command(
      "record",
      "Write every change of a device's points to a file, with its time, until Ctrl-C. Never writes to it.");
  const auto arguments = std::make_shared<Arguments>();
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
      "Example:\n  coupler record press.yaml -o press.jsonl\n  coupler record 192.168.1.20\n"
      "To play it: coupler-node --sim --replay press.jsonl\n"
      "Exit status 3: the device was never reached, or what came last could not be written.");
  command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace coupler::tools
