// SPDX-License-Identifier: Apache-2.0
#include "device/keeper/keeper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "device/keeper/backoff.hpp"

namespace coupler::node {
namespace {

constexpr std::chrono::milliseconds glance{100};
constexpr std::chrono::seconds look_period{1};

}  // namespace

bool Keeper::run(std::vector<OpenConnection> clients) {
  for (Backoff backoff;;) {
    const TimePoint started = TimePoint::clock::now();
    const auto work = [&](Superior& superior) { return charge_.serve(superior, std::move(clients)); };
    auto process = IoProcess::start(loop_, work, heard_);
    clients.clear();
    const IoProcess::End end =
        process ? watch_over(**process)
                : IoProcess::End{false, fmt::format("cannot be started: {}", std::strerror(process.error()))};
    const bool makes_room = to_change_ && end.in_order && signals_.stop() == 0;
    const bool safe = makes_room || charge_.make_safe();
    if (signals_.stop() != 0) return safe;
    if (makes_room) clients = (*process)->take_clients();
    if (std::exchange(to_change_, false)) charge_.change(clients);
    if (makes_room) continue;
    const auto pause = backoff.after(TimePoint::clock::now() - started);
    log_.warn(fmt::format(
        "the I/O process {}; {}; starting it again in {} ms", end.how,
        safe ? "outputs are in their safe state" : "not every output could be driven to its safe state",
        pause.count()));
    rest(pause);
    if (signals_.stop() != 0) return charge_.make_safe();
  }
}

IoProcess::End Keeper::watch_over(IoProcess& process) {
  // A glance counts for no longer than it lasts: this process may have been stopped itself, and what the
  // other said meanwhile still waits to be heard. Nor for longer than it took: a signal cuts it short.
  using std::chrono::nanoseconds;
  TimePoint heard = process.last_beat();
  for (nanoseconds silence{0}; silence < patience; heard = process.last_beat()) {
    const TimePoint before = TimePoint::clock::now();
    const TimePoint now = loop_.run_once(glance);
    if (signals_.stop() != 0) {
      process.terminate();
      return wait_for(process);
    }
    if (process.has_ended()) return process.end();
    if (is_to_change(now)) {
      process.make_room();
      return wait_for(process);
    }
    const bool is_silent = process.last_beat() == heard;
    silence = is_silent ? silence + std::min<nanoseconds>(glance, now - before) : nanoseconds(0);
  }
  IoProcess::End end = process.end();
  end.how = fmt::format("was silent for {} s and {}", patience.count(), end.how);
  return end;
}

IoProcess::End Keeper::wait_for(IoProcess& process) {
  TimePoint now = TimePoint::clock::now();
  for (const TimePoint until = now + patience; now < until && !process.has_ended();)
    now = loop_.run_once(glance);
  return process.end();
}

bool Keeper::is_to_change(TimePoint now) {
  if (signals_.take_reload()) to_change_ = charge_.reload();
  if (!to_change_ && now >= next_look_) {
    next_look_ = now + look_period;
    to_change_ = charge_.look_after(now);
  }
  return to_change_;
}

void Keeper::rest(std::chrono::milliseconds pause) {
  TimePoint now = TimePoint::clock::now();
  for (const TimePoint until = now + pause; now < until && signals_.stop() == 0;)
    now = loop_.run_once(glance);
}

}  // namespace coupler::node
