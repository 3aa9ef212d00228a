// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "coupler/base/never_wait.hpp"
#include "coupler/cli/live_device.hpp"
#include "coupler/host/cli/interruption.hpp"
#include "coupler/host/cli/read_only_map.hpp"
#include "coupler/host/cli/report_line.hpp"
#include "coupler/host/core/clock.hpp"
#include "coupler/host/core/device_thread.hpp"
#include "coupler/host/modbus/make_links.hpp"
#include "coupler/host/record/record_thread.hpp"
#include "coupler/map/loader/load.hpp"
#include "coupler/map/node_address.hpp"

namespace coupler::cli {
namespace {

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

tl::expected<host::RecordFile, std::string> open_file(const RecordOptions& options) {
  if (options.file == "-") return host::RecordFile::standard_output();
  return host::RecordFile::open(options.file, {options.keep, options.sync});
}

}  // namespace

Exit record(const Map& original, const RecordOptions& options) {
  const ReadOnlyMap looking(original);
  const Map& map = looking.map();
  auto file = open_file(options);
  if (!file) return complain("record", bad_call, file.error(), {});
  host::Link link = host::make_link(map.connection, map.limits);
  never_wait_for_reader_of(STDERR_FILENO);
  if (options.file != "-") std::signal(SIGPIPE, SIG_IGN);  // a recording outlives the reader of its messages
  const host::Clock& clock = link.clock();
  host::SteadyClock pause;
  std::atomic<bool> stopped{false};
  const auto format = options.csv ? host::csv_format() : host::json_format();
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
  host::RecordThread writing(recorder, *std::move(file), say);
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

}  // namespace coupler::cli
