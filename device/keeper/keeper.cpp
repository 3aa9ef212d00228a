// SPDX-License-Identifier: Apache-2.0
#include "device/keeper/keeper.hpp"

#include <fmt/format.h>

#include <cstring>

#include "device/keeper/backoff.hpp"

namespace coupler::node {
namespace {

constexpr std::chrono::milliseconds glance{100};

std::string how_it_ended(IoProcess& process, bool was_silent) {
  const std::string how = process.end();
  return was_silent ? fmt::format("was silent for {} s and {}", Keeper::patience.count(), how) : how;
}

}  // namespace

bool Keeper::run(const IoProcess::Work& work) {
  Backoff backoff;
  for (;;) {
    const TimePoint started = TimePoint::clock::now();
    auto process = IoProcess::start(loop_, work, heard_);
    const std::string how = process ? watch_over(**process)
                                    : fmt::format("cannot be started: {}", std::strerror(process.error()));
    const bool safe = lines_.drive_safe();
    if (signals_.stop() != 0) return safe;
    const auto pause = backoff.after(TimePoint::clock::now() - started);
    log_.write(fmt::format(
        "the I/O process {}; {}; starting it again in {} ms", how,
        safe ? "outputs are in their safe state" : "not every output could be driven to its safe state",
        pause.count()));
    rest(pause);
    if (signals_.stop() != 0) return lines_.drive_safe();
  }
}

std::string Keeper::watch_over(IoProcess& process) {
  // Silence is counted in glances, not by the clock: this process may have been stopped itself, and what the
  // other said meanwhile still waits to be heard.
  TimePoint heard = process.last_beat();
  for (auto silence = glance * 0; silence < patience; heard = process.last_beat()) {
    loop_.run_once(glance);
    if (signals_.stop() != 0) return end_in_peace(process);
    if (process.has_ended()) return how_it_ended(process, false);
    silence = process.last_beat() == heard ? silence + glance : glance * 0;
  }
  return how_it_ended(process, true);
}

std::string Keeper::end_in_peace(IoProcess& process) {
  process.terminate();
  TimePoint now = TimePoint::clock::now();
  for (const TimePoint until = now + patience; now < until && !process.has_ended();)
    now = loop_.run_once(glance);
  return how_it_ended(process, false);
}

void Keeper::rest(std::chrono::milliseconds pause) {
  TimePoint now = TimePoint::clock::now();
  for (const TimePoint until = now + pause; now < until && signals_.stop() == 0;)
    now = loop_.run_once(glance);
}

}  // namespace coupler::node
