// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/keeper/keeper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <utility>

#include "coupler/device/keeper/backoff.hpp"
#include "coupler/device/keeper/cpu_time.hpp"
#include "coupler/device/keeper/safety.hpp"
#include "coupler/device/keeper/silence.hpp"

namespace coupler::device {
namespace {

constexpr std::chrono::milliseconds glance{100};
/// Ten in the time after which an I/O process takes its keeper for dead.
constexpr std::chrono::milliseconds beat_period = std::chrono::milliseconds(Superior::patience) / 10;

}  // namespace

bool Keeper::run() {
  Clients clients;
  for (Backoff backoff; signals_.stop() == 0;) {
    const TimePoint started = TimePoint::clock::now();
    const bool makes_room = run_one(clients);
    if (signals_.stop() != 0) break;
    if (std::exchange(to_change_, false)) charge_.change(clients);
    if (makes_room) continue;
    const auto pause = backoff.after(TimePoint::clock::now() - started);
    log_.warn(fmt::format(
        "the I/O process {}; {}; starting it again in {} ms", how_it_ended_,
        is_safe_ ? "outputs are in their safe state" : "not every output could be driven to its safe state",
        pause.count()));
    rest(pause);
    if (signals_.stop() != 0) make_safe(false);
  }
  return is_safe_;
}

bool Keeper::run_one(Clients& clients) {
  const auto work = [&](Superior& superior) { return charge_.serve(superior, std::move(clients)); };
  auto process = IoProcess::start(loop_, work, heard_);
  clients.clear();
  if (!process) {
    how_it_ended_ = fmt::format("cannot be started: {}", std::strerror(process.error()));
    make_safe(true);
    return false;
  }
  const IoProcess::End end = watch_over(**process);
  how_it_ended_ = end.how;
  const bool makes_room = to_change_ && end.in_order && signals_.stop() == 0;
  if (makes_room)
    clients = (*process)->take_clients();
  else
    make_safe(!end.in_order);
  return makes_room;
}

IoProcess::End Keeper::watch_over(IoProcess& process) {
  TimePoint now = TimePoint::clock::now();
  CpuWait cpu_wait(process.pid());
  Silence silence(now, glance, cpu_wait.sample(now));
  for (TimePoint heard = process.last_beat(), next_beat{}; !silence.is_too_long();) {
    if (now >= next_beat) {
      process.beat();
      next_beat = now + beat_period;
    }
    now = loop_.run_once(glance);
    if (signals_.stop() != 0) {
      process.terminate(signals_.stop() == SIGINT ? SIGINT : SIGTERM);
      return wait_for(process);
    }
    if (process.has_ended()) return end(process);
    if (is_to_change(now)) {
      process.make_room();
      return wait_for(process);
    }
    if (has_lost_one_ended()) {
      IoProcess::End end = this->end(process);
      end.in_order = false;
      end.how = "was replaced, since one before it, which hung, may have moved lines when it ended";
      return end;
    }
    const bool was_heard = process.last_beat() != std::exchange(heard, process.last_beat());
    silence.sample(now, was_heard, cpu_wait.sample(now));
  }
  IoProcess::End end = this->end(process);
  end.how = fmt::format("was silent for {:.1f} s and {}",
                        std::chrono::duration<double>(silence.lasted()).count(), end.how);
  return end;
}

IoProcess::End Keeper::wait_for(IoProcess& process) {
  TimePoint now = TimePoint::clock::now();
  for (const TimePoint until = now + patience; now < until && !process.has_ended();)
    now = loop_.run_once(glance);
  return end(process);
}

IoProcess::End Keeper::end(IoProcess& process) {
  IoProcess::End end = process.end();
  if (!end.is_gone) lost_.push_back(process.take_child());
  return end;
}

bool Keeper::is_to_change(TimePoint now) {
  if (signals_.take_suspend())
    log_.warn("Ctrl-Z is not obeyed: a stopped node could not keep its outputs safe; Ctrl-C ends it");
  if (const auto asker = signals_.take_reload()) charge_.reload(*asker);
  to_change_ = to_change_ || charge_.look_after(now);
  return to_change_;
}

bool Keeper::has_lost_one_ended() {
  const auto ended = [](Child& child) { return child.wait(std::chrono::milliseconds(0)).has_value(); };
  const auto first = std::remove_if(lost_.begin(), lost_.end(), ended);
  const bool any = first != lost_.end();
  lost_.erase(first, lost_.end());
  return any;
}

void Keeper::make_safe(bool firmware_too) { is_safe_ = device::make_safe(charge_, firmware_too, lost_); }

void Keeper::rest(std::chrono::milliseconds pause) {
  TimePoint now = TimePoint::clock::now();
  for (const TimePoint until = now + pause; now < until && signals_.stop() == 0;)
    now = loop_.run_once(glance);
}

}  // namespace coupler::device
