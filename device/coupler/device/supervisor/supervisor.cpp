// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/supervisor/supervisor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <functional>
#include <utility>

#include "coupler/device/supervisor/cpu_time.hpp"
#include "coupler/device/supervisor/heartbeat.hpp"
#include "coupler/device/supervisor/safety_processes.hpp"

namespace coupler::device {
namespace {

/// How often the loop turns at least.
constexpr std::chrono::milliseconds turn{100};
/// Ten in the time after which a worker process takes its supervisor for dead.
constexpr std::chrono::milliseconds beat_period = std::chrono::milliseconds(SupervisorLink::timeout) / 10;

bool all_safe(const std::vector<SafeOutcome>& outcomes) {
  return std::all_of(outcomes.begin(), outcomes.end(),
                     [](SafeOutcome outcome) { return outcome == SafeOutcome::safe; });
}

/// False: an output could not be driven back, or it took too long.
bool end_durations(Workload& workload, const std::vector<SafeOutcome>& parts, std::vector<Child>& lost) {
  SafetyProcesses last(lost);
  if (last.start([&] { return workload.end_durations(parts); })) return all_safe(last.finish());
  const bool any_hangs = std::count(parts.begin(), parts.end(), SafeOutcome::hangs) != 0;
  return !any_hangs && workload.end_durations(parts);
}

/// Drives the outputs of the workload to their safe state while nobody else does, and at the same time what
/// its firmware is behind if that is wanted. False: one could not be driven, or took too long. A process that
/// cannot be killed is added to `lost`.
bool make_safe(Workload& workload, bool firmware_too, std::vector<Child>& lost) {
  const std::size_t parts = workload.begin_safe();
  SafetyProcesses outputs(lost);
  std::vector<std::pair<std::size_t, SafeOutcome>> without;  // parts for which there is no process
  for (std::size_t part = 0; part < parts; ++part)
    if (!outputs.start([&] { return workload.drive_safe(part); }))
      without.emplace_back(part, SafeOutcome::unasked);
  // It may take its time, which neither outputs nor the ends of durations wait for.
  SafetyProcesses firmware(lost);
  if (firmware_too && workload.has_firmware()) firmware.start([&] { return workload.make_firmware_safe(); });
  for (auto& [part, outcome] : without)
    outcome = workload.drive_safe(part) ? SafeOutcome::safe : SafeOutcome::failed;
  std::vector<SafeOutcome> outcomes = outputs.finish();
  for (const auto& [part, outcome] : without) outcomes[part] = outcome;
  bool safe = all_safe(outcomes);
  if (workload.went_safe(outcomes)) safe &= end_durations(workload, outcomes, lost);
  return all_safe(firmware.finish()) && safe;
}

}  // namespace

bool Supervisor::run() {
  Clients clients;
  for (Backoff backoff; signals_.stop() == 0;) {
    const TimePoint started = TimePoint::clock::now();
    const bool makes_room = run_one(clients);
    if (signals_.stop() != 0) break;
    if (std::exchange(to_change_, false)) workload_.change(clients);
    if (makes_room) continue;
    const auto pause = backoff.after(TimePoint::clock::now() - started);
    log_.warn(fmt::format(
        "the worker process {}; {}; starting it again in {} ms", how_it_ended_,
        is_safe_ ? "outputs are in their safe state" : "not every output could be driven to its safe state",
        pause.count()));
    wait(pause);
    if (signals_.stop() != 0) make_safe(false);
  }
  return is_safe_;
}

bool Supervisor::run_one(Clients& clients) {
  const auto work = [&](SupervisorLink& supervisor) {
    return workload_.serve(supervisor, std::move(clients));
  };
  auto process = Worker::start(loop_, work, [&] { workload_.beat(); });
  clients.clear();
  if (!process) {
    how_it_ended_ = fmt::format("cannot be started: {}", std::strerror(process.error()));
    make_safe(true);
    return false;
  }
  const Worker::End end = watch_over(**process);
  how_it_ended_ = end.how;
  const bool makes_room = to_change_ && end.in_order && signals_.stop() == 0;
  if (makes_room)
    clients = (*process)->take_clients();
  else
    make_safe(!end.in_order);
  return makes_room;
}

Worker::End Supervisor::watch_over(Worker& process) {
  TimePoint now = TimePoint::clock::now();
  CpuWait cpu_wait(process.pid());
  Silence silence(now, turn, cpu_wait.sample(now));
  for (TimePoint heard = process.last_beat(), next_beat{}; !silence.is_too_long();) {
    if (now >= next_beat) {
      process.beat();
      next_beat = now + beat_period;
    }
    now = loop_.run_once(turn);
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
      Worker::End end = this->end(process);
      end.in_order = false;
      end.how = "was replaced: an earlier one, which hung, has ended and may have driven lines";
      return end;
    }
    const bool was_heard = process.last_beat() != std::exchange(heard, process.last_beat());
    silence.sample(now, was_heard, cpu_wait.sample(now));
  }
  Worker::End end = this->end(process);
  end.how = fmt::format("was silent for {:.1f} s and {}",
                        std::chrono::duration<double>(silence.lasted()).count(), end.how);
  return end;
}

Worker::End Supervisor::wait_for(Worker& process) {
  TimePoint now = TimePoint::clock::now();
  CpuWait cpu_wait(process.pid());
  Silence silence(now, turn, cpu_wait.sample(now));
  while (!silence.is_too_long() && !process.has_ended()) {
    now = loop_.run_once(turn);
    silence.sample(now, false, cpu_wait.sample(now));
  }
  return end(process);
}

Worker::End Supervisor::end(Worker& process) {
  Worker::End end = process.end();
  if (!end.is_gone) lost_.push_back(process.take_child());
  return end;
}

bool Supervisor::is_to_change(TimePoint now) {
  if (signals_.take_suspend())
    log_.warn("Ctrl-Z is ignored: a stopped node could not keep its outputs safe; Ctrl-C ends it");
  if (const auto requester = signals_.take_reload()) workload_.reload(*requester);
  to_change_ = to_change_ || workload_.look_after(now);
  return to_change_;
}

bool Supervisor::has_lost_one_ended() {
  const auto ended = [](Child& child) { return child.wait(std::chrono::milliseconds(0)).has_value(); };
  const auto first = std::remove_if(lost_.begin(), lost_.end(), ended);
  const bool any = first != lost_.end();
  lost_.erase(first, lost_.end());
  return any;
}

void Supervisor::make_safe(bool firmware_too) {
  is_safe_ = device::make_safe(workload_, firmware_too, lost_);
}

void Supervisor::wait(std::chrono::milliseconds pause) {
  TimePoint now = TimePoint::clock::now();
  for (const TimePoint until = now + pause; now < until && signals_.stop() == 0;) now = loop_.run_once(turn);
}

}  // namespace coupler::device
