// SPDX-License-Identifier: Apache-2.0
#include "coupler/cli/live_device.hpp"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "coupler/base/never_wait.hpp"
#include "coupler/host/cli/device_reader.hpp"
#include "coupler/host/cli/dump_output.hpp"
#include "coupler/host/cli/interruption.hpp"
#include "coupler/host/cli/modbus_client.hpp"
#include "coupler/host/core/backoff.hpp"
#include "coupler/host/core/clock.hpp"
#include "coupler/host/core/wall_time.hpp"
#include "coupler/host/modbus/make_links.hpp"
#include "coupler/map/diagnostic.hpp"
#include "coupler/map/node_address.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::cli {
namespace {

/// A device that ends each connection is not asked without end.
constexpr std::chrono::seconds pause_after_loss(1);

void put_line(const std::string& line) {
  std::puts(line.c_str());
  std::fflush(stdout);
}

void tell(const std::string& note) {
  std::fputs(fmt::format("coupler dump: note: {}\n", printable_lines(note)).c_str(), stderr);
}

/// False while whoever reads standard output stands still.
bool is_taken() {
  pollfd wish{STDOUT_FILENO, POLLOUT, 0};
  return ::poll(&wish, 1, 0) != 0;
}

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

Exit once(const Map& map, const DumpOptions& options) {
  host::Link link = host::make_link(map.connection, map.limits);
  DeviceReader reader(map, options.chosen, link, load_served_map);
  const Snapshot now = reader.look();
  const bool nothing = std::none_of(now.readings.begin(), now.readings.end(), [](const Reading& reading) {
    return reading.state == Reading::State::good;
  });
  if (options.json) {
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

/// Looks again and again, and hears in between of what the device announces.
class Watch {
 public:
  Watch(const Map& map, const DumpOptions& options, Show show)
      : map_(map),
        every_(*options.every),
        show_(show),
        link_(host::make_link(map.connection, map.limits)),
        interruption_([this] {
          stopped_ = true;
          link_.interrupt();
          link_.wake();
        }),
        reader_(map, options.chosen, link_, load_served_map,
                [this](const modbus::Change& bit, host::Stamp stamp) { take(bit, stamp); }) {}

  /// Until it is interrupted.
  void run() {
    while (!stopped_) wait_until(look());
  }

 private:
  /// Returns when to look again.
  host::Time look() {
    const host::Time next = clock_.now() + every_;
    Snapshot now = reader_.look();
    if (stopped_) return next;
    const bool is_online = now.online();
    if (is_online) {
      backoff_.reset();
      if (online_.online() && !online_.readings.empty()) mark_changes(online_, now);
      online_ = now;
    }
    show_if_taken(std::exchange(is_first_, false) ? nullptr : &before_, now);
    before_ = std::move(now);
    if (is_online) {
      was_told_ = false;
      return next;
    }
    const host::Time again = clock_.now() + backoff_.next();
    return was_told_ ? again : std::max(next, again);  // what comes between two looks is not told meanwhile
  }

  void wait_until(host::Time next) {
    was_told_ |= reader_.hears_changes();
    auto lost = reader_.wait_until(next);
    if (!lost || stopped_) return;
    show_if_taken(&before_, *lost);
    before_ = *std::move(lost);
    clock_.sleep_until(std::min<host::Time>(next, clock_.now() + pause_after_loss));
  }

  void take(const modbus::Change& bit, host::Stamp stamp) {
    if (!before_.online() || !take_change(map_, bit, before_)) return;
    wall_.measure();
    before_.at = std::chrono::system_clock::time_point(
        std::chrono::duration_cast<std::chrono::system_clock::duration>(wall_.of(stamp.at)));
    online_ = before_;
    show_if_taken(&before_, before_);
  }

  /// Lines that nobody reads are not shown, so that the device is read and Ctrl-C is heard all the same.
  void show_if_taken(const Snapshot* before, const Snapshot& now) {
    if (!is_taken()) {
      ++missing_;
      is_first_ |= before == nullptr;
      return;
    }
    if (const unsigned missing = std::exchange(missing_, 0); missing > 0)
      tell(fmt::format("{} looks are missing here: standard output was blocked", missing));
    show_(map_, before, now);
  }

  const Map& map_;
  const host::Duration every_;
  const Show show_;
  host::Link link_;
  host::Clock& clock_ = link_.clock();
  std::atomic<bool> stopped_{false};
  const Interruption interruption_;
  host::Backoff backoff_;
  host::WallTime wall_;
  Snapshot before_;
  Snapshot online_;        ///< the last that was
  bool is_first_ = true;   ///< nothing has been shown
  unsigned missing_ = 0;   ///< that were not shown since the last one that was
  bool was_told_ = false;  ///< the device told its changes, until the connection ended
  DeviceReader reader_;    // last: it uses the others
};

Exit again_and_again(const Map& map, const DumpOptions& options) {
  never_wait_for_reader_of(STDERR_FILENO);
  const bool terminal = !options.json && is_screen();
  if (terminal) std::fputs(begin_frames, stdout);
  Watch(map, options, options.json ? show_json : terminal ? show_frame : show_changes).run();
  if (terminal) put_line(end_frames);
  return ok;
}

}  // namespace

Exit dump(const Map& map, const DumpOptions& options) {
  return options.every ? again_and_again(map, options) : once(map, options);
}

}  // namespace coupler::cli
