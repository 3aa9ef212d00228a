// SPDX-License-Identifier: Apache-2.0
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coupler/base/never_wait.hpp"
#include "coupler/host/core/device_thread.hpp"
#include "coupler/host/modbus/make_links.hpp"
#include "coupler/map/diagnostic.hpp"
#include "coupler/map/name_pattern.hpp"
#include "coupler/map/nearest.hpp"
#include "coupler/map/node_address.hpp"
#include "coupler/map/printable.hpp"
#include "coupler/tools/commands.hpp"
#include "coupler/tools/device_argument.hpp"
#include "coupler/tools/device_looks.hpp"
#include "coupler/tools/dump_output.hpp"
#include "coupler/tools/interruption.hpp"
#include "coupler/tools/modbus_client.hpp"
#include "coupler/tools/read_only_map.hpp"

namespace coupler::tools {
namespace {

struct Arguments {
  DeviceArgument device;
  std::vector<std::string> points;
  double every = 0;  ///< s; 0: not given
  bool watch = false;
  bool json = false;
};

/// The period of the cycles in a single look. Points that the first cycle does not read are read in the
/// next one or two.
constexpr std::chrono::seconds once_period(2);

constexpr double usual_period = 1;  ///< s, of --watch

void put_line(const std::string& line) {
  std::puts(line.c_str());
  std::fflush(stdout);
}

void tell(const std::string& note) {
  std::fputs(fmt::format("coupler dump: note: {}\n", printable_lines(note)).c_str(), stderr);
}

/// A device that hangs takes several timeouts, and somebody waits.
void tell_of_silence() { tell("a request had no answer; the device is asked in other ways"); }

/// Returns false while standard output is blocked because its reader does not read.
bool is_taken() {
  pollfd wish{STDOUT_FILENO, POLLOUT, 0};
  return ::poll(&wish, 1, 0) != 0;
}

/// Returns the number of rows of the terminal that is standard output.
std::size_t terminal_rows() {
  winsize size{};
  return ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_row > 0 ? size.ws_row : 24;
}

/// Returns whether standard output is a terminal that understands ANSI sequences.
bool is_screen() {
  const char* kind = std::getenv("TERM");
  return ::isatty(STDOUT_FILENO) == 1 && kind != nullptr && std::string_view(kind) != "dumb";
}

void show_frame(const Map& map, const Snapshot* /*before*/, const Snapshot& now) {
  const std::string text = frame(table_lines(map, now, colour_of(STDOUT_FILENO)), terminal_rows());
  put(text);
  std::fflush(stdout);
}

void show_json(const Map& map, const Snapshot* /*before*/, const Snapshot& now) {
  put_line(dump_json(map, now));
}

void show_changes(const Map& map, const Snapshot* before, const Snapshot& now) {
  if (now.online() && (before == nullptr || before->notes != now.notes))
    for (const std::string& note : now.notes) tell(note);
  for (const std::string& line : change_lines(map, before, now)) put_line(line);
}

/// Holds the snapshots that are still to be shown, so that slow output does not delay the reading of the
/// device.
class SnapshotQueue {
 public:
  void push(Snapshot snapshot) {
    {
      const std::lock_guard lock(mutex_);
      if (waiting_.size() == longest) {
        waiting_.pop_front();
        ++missing_;
      }
      waiting_.push_back(std::move(snapshot));
    }
    changed_.notify_all();
  }
  /// Waits for the next one; nullopt after stop().
  std::optional<Snapshot> next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return stopped_ || !waiting_.empty(); });
    if (stopped_) return std::nullopt;
    Snapshot snapshot = std::move(waiting_.front());
    waiting_.pop_front();
    return snapshot;
  }
  /// Returns how many there was no room for since the last call.
  unsigned take_missing() {
    const std::lock_guard lock(mutex_);
    return std::exchange(missing_, 0);
  }
  void stop() {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    changed_.notify_all();
  }

 private:
  static constexpr std::size_t longest = 100;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Snapshot> waiting_;
  unsigned missing_ = 0;
  bool stopped_ = false;
};

/// A device that a thread of its own reads.
class ReadDevice {
 public:
  ReadDevice(const Map& map, const std::vector<bool>& chosen, SnapshotQueue& queue,
             std::function<void()> on_silence)
      : link_(host::make_link(map.connection, map.limits)),
        values_(map),
        looks_(
            map, chosen, values_, link_.clock(),
            [&queue](Snapshot snapshot) { queue.push(std::move(snapshot)); }, std::move(on_silence)),
        thread_(map, {map.verify, true}, load_served_map, link_, values_, looks_) {
    for (std::uint32_t point = 0; point < map.points.size(); ++point)
      if (!chosen[point]) thread_.want(point, false);
    thread_.start();
  }

  /// Ends the connection.
  void end() { thread_.end(); }

 private:
  host::Link link_;
  host::ValueTable values_;
  DeviceLooks looks_;
  host::DeviceThread thread_;  // last: it uses the others
};

Exit once(const Map& original, const std::vector<bool>& chosen, bool json) {
  const ReadOnlyMap looking(original, once_period);
  Map map = looking.map();
  map.changes = false;
  SnapshotQueue queue;
  ReadDevice device(map, chosen, queue, tell_of_silence);
  const Snapshot now = *queue.next();
  device.end();
  const bool nothing = std::none_of(now.readings.begin(), now.readings.end(), [](const Reading& reading) {
    return reading.state == Reading::State::good;
  });
  if (json) {
    put_line(dump_json(map, now));
  } else if (now.online() || !nothing) {
    for (const std::string& line : table_lines(map, now, Colour::no)) put_line(line);
  }
  if (!now.online())
    complain("dump", failed, node_address_text(map.connection) + ": " + to_string(*now.error),
             reach_remedy(map.connection, *now.error,
                          "check that a device serves there, or give another place with --at"));
  return now.online() && now.failed() == 0 ? ok : failed;
}

using Show = void (*)(const Map& map, const Snapshot* before, const Snapshot& now);

/// Shows the snapshots from the queue. While standard output is blocked it skips them, so that the program
/// does not hang and Ctrl-C still ends it.
void watch(SnapshotQueue& queue, const Map& map, Show show) {
  std::optional<Snapshot> shown;
  unsigned missing = 0;
  while (std::optional<Snapshot> now = queue.next()) {
    missing += queue.take_missing();
    if (!is_taken()) {
      ++missing;
      continue;
    }
    if (missing > 0) tell(fmt::format("{} looks are missing here: standard output was blocked", missing));
    missing = 0;
    show(map, shown ? &*shown : nullptr, *now);
    shown = *std::move(now);
  }
}

Exit again_and_again(const Map& original, const std::vector<bool>& chosen, bool json,
                     std::chrono::nanoseconds period) {
  never_wait_for_reader_of(STDERR_FILENO);
  const ReadOnlyMap looking(original, period);
  const Map& map = looking.map();
  SnapshotQueue queue;
  const Interruption interruption([&] { queue.stop(); });
  const bool terminal = !json && is_screen();
  ReadDevice device(map, chosen, queue, terminal ? [] {} : tell_of_silence);
  if (terminal) std::fputs(begin_frames, stdout);
  watch(queue, map, json ? show_json : terminal ? show_frame : show_changes);
  if (terminal) put_line(end_frames);
  return ok;
}

/// Returns for each point whether it is chosen. The error is a pattern that matches no point, because a
/// misspelt one would silently leave points out.
tl::expected<std::vector<bool>, std::string> choose(const Map& map,
                                                    const std::vector<std::string>& patterns) {
  std::vector<bool> chosen(map.points.size(), patterns.empty());
  for (const std::string& pattern : patterns)
    if (!mark_matching(pattern, map.points, chosen)) return tl::make_unexpected(pattern);
  return chosen;
}

std::string_view near_point(const Map& map, std::string_view word) {
  std::vector<std::string_view> names;
  for (const Point& point : map.points) names.push_back(point.name);
  return nearest(word, names);
}

Exit run(const Arguments& arguments) {
  const auto device = get_device("dump", arguments.device);
  if (!device) return device.error();
  const auto chosen = choose(device->map, arguments.points);
  if (!chosen) {
    const std::string_view near = near_point(device->map, chosen.error());
    return complain(
        "dump", bad_call, fmt::format("no point matches '{}'", chosen.error()),
        !near.empty() ? fmt::format("did you mean '{}'?", near)
                      : fmt::format("`coupler export {} --to csv` lists their names", arguments.device.map));
  }
  if (!arguments.watch) return once(device->map, *chosen, arguments.json);
  const std::chrono::duration<double> period(arguments.every > 0 ? arguments.every : usual_period);
  return again_and_again(device->map, *chosen, arguments.json,
                         std::chrono::duration_cast<std::chrono::nanoseconds>(period));
}

}  // namespace

void add_dump(Program& program, Exit& exit) {
  auto command = program.add_command(
      "dump", "Read every point of a device and show its value, or why there is none. Never writes to it.");
  const auto arguments = std::make_shared<Arguments>();
  add_device_options(command, arguments->device);
  command
      .add_option("--points", arguments->points, "Only points whose names match, as in 'pump_*'; repeatable")
      .delimiter(',')
      .no_extra_values()
      .type_name("GLOB");
  auto watch = command
                   .add_option("--watch", arguments->every,
                               "Repeat every so many seconds, default 1, until Ctrl-C: in place on a "
                               "terminal, else with a line for each change")
                   .optional_value()
                   .in_range(0.05, 86400.0)
                   .type_name("SECONDS");
  command.add_flag("--json", arguments->json,
                   "One JSON object on standard output, for scripts; with --watch one per line");
  command.footer(
      "Example:\n  coupler dump raspberrypi\n  coupler dump device.yaml --at 10.0.0.7 --points "
      "'pump_*' --watch 0.5\n"
      "Exit status 3: the device cannot be reached, or a point cannot be read.");
  command.callback([arguments, watch, &exit] {
    arguments->watch = watch.given();
    exit = run(*arguments);
  });
}

}  // namespace coupler::tools
