// SPDX-License-Identifier: Apache-2.0
#include "coupler/cli/live_device.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/cli/device_reader.hpp"
#include "coupler/host/cli/dump_output.hpp"
#include "coupler/host/cli/interruption.hpp"
#include "coupler/host/cli/modbus_client.hpp"
#include "coupler/host/core/clock.hpp"
#include "coupler/host/core/schedule.hpp"
#include "coupler/host/core/wall_time.hpp"
#include "coupler/host/modbus/multi_unit_transport.hpp"
#include "coupler/map/diagnostic.hpp"
#include "coupler/map/node_address.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::cli {
namespace {

/// A device that ends each connection is not asked without end.
constexpr std::chrono::seconds pause_after_loss(1);

void put(const std::string& line) {
  std::puts(line.c_str());
  std::fflush(stdout);
}

void tell(const std::string& note) { fmt::print(stderr, "coupler dump: note: {}\n", printable_lines(note)); }

/// Rows of the terminal that is standard output.
std::size_t terminal_rows() {
  winsize size{};
  return ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_row > 0 ? size.ws_row : 24;
}

/// Some terminals know no ANSI sequences.
bool is_screen() {
  const char* kind = std::getenv("TERM");
  return ::isatty(STDOUT_FILENO) == 1 && kind != nullptr && std::string_view(kind) != "dumb";
}

void show_frame(const Map& map, const Snapshot* /*before*/, const Snapshot& now) {
  const std::string text = frame(table_lines(map, now, colour_of(STDOUT_FILENO)), terminal_rows());
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
}

void show_json(const Map& map, const Snapshot* /*before*/, const Snapshot& now) { put(dump_json(map, now)); }

void show_changes(const Map& map, const Snapshot* before, const Snapshot& now) {
  if (now.online() && (before == nullptr || before->notes != now.notes))
    for (const std::string& note : now.notes) tell(note);
  for (const std::string& line : change_lines(map, before, now)) put(line);
}

Exit once(const Map& map, const DumpOptions& options) {
  const auto transport = host::make_transport(map.connection);
  host::SteadyClock clock;
  DeviceReader reader(map, options.chosen, *transport, clock, load_served_map);
  const Snapshot now = reader.look();
  const bool nothing = std::none_of(now.readings.begin(), now.readings.end(), [](const Reading& reading) {
    return reading.state == Reading::State::good;
  });
  if (options.json) {
    put(dump_json(map, now));
  } else if (now.online() || !nothing) {
    for (const std::string& line : table_lines(map, now, Colour::no)) put(line);
  }
  if (!now.online())
    complain("dump", failed, node_address_text(map.connection) + ": " + to_string(*now.error),
             reach_remedy(map.connection, *now.error,
                          "check that a device serves there, or give another place with --at"));
  return now.online() && now.failed() == 0 ? ok : failed;
}

Exit again_and_again(const Map& map, const DumpOptions& options) {
  const auto transport = host::make_transport(map.connection);
  host::SteadyClock clock;
  std::atomic<bool> stopped{false};
  const Interruption interruption([&] {
    stopped = true;
    transport->interrupt();
    transport->wake();
    clock.stop();
  });
  host::Backoff backoff;
  const bool terminal = !options.json && is_screen();
  const auto show = options.json ? show_json : terminal ? show_frame : show_changes;
  if (terminal) std::fputs(begin_frames, stdout);
  Snapshot before;
  Snapshot online;  // the last that was
  host::WallTime wall;
  DeviceReader reader(
      map, options.chosen, *transport, clock, load_served_map,
      [&](const modbus::Change& bit, host::Stamp stamp) {
        if (!before.online() || !take_change(map, bit, before)) return;
        wall.measure();
        before.at = std::chrono::system_clock::time_point(
            std::chrono::duration_cast<std::chrono::system_clock::duration>(wall.of(stamp.at)));
        online = before;
        show(map, &before, before);
      });
  bool was_told = false;  // the device told its changes, until the connection ended
  for (bool first = true; !stopped; first = false) {
    host::Time next = clock.now() + *options.every;
    Snapshot now = reader.look();
    if (stopped) break;
    if (now.online()) {
      backoff.reset();
      was_told = false;
      if (online.online() && !online.readings.empty()) mark_changes(online, now);
      online = now;
    } else {
      const host::Time again = clock.now() + backoff.next();
      next = was_told ? again : std::max(next, again);  // what comes between two looks is not told meanwhile
    }
    show(map, first ? nullptr : &before, now);
    before = std::move(now);
    auto lost = reader.wait_until(next);
    if (!lost || stopped) continue;
    was_told = true;
    show(map, &before, *lost);
    before = *std::move(lost);
    clock.sleep_until(std::min<host::Time>(next, clock.now() + pause_after_loss));
  }
  if (terminal) put(end_frames);
  return ok;
}

}  // namespace

Exit dump(const Map& map, const DumpOptions& options) {
  return options.every ? again_and_again(map, options) : once(map, options);
}

}  // namespace coupler::cli
