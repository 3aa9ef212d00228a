// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/supervisor/safety_processes.hpp"

#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <utility>

#include "coupler/device/supervisor/cpu_time.hpp"
#include "coupler/device/supervisor/heartbeat.hpp"

namespace coupler::device {
namespace {

using std::chrono::milliseconds;

/// How often the processes are looked at at least.
constexpr milliseconds turn{100};
/// The time limit for all processes that were killed: the kernel needs time to free their memory.
constexpr milliseconds time_to_die{1000};

}  // namespace

class SafetyProcesses::Process {
 public:
  Process(Child child, std::size_t work)
      : child_(std::move(child)),
        work_(work),
        cpu_wait_(child_.pid()),
        silence_(TimePoint::clock::now(), turn, cpu_wait_.sample(TimePoint::clock::now())) {}

  std::size_t work() const { return work_; }
  SafeOutcome outcome() const { return outcome_; }
  bool is_over() const { return is_over_; }
  /// Waits for its end for so long, and kills it if it takes too long.
  void look(milliseconds at_most) {
    if (is_over_) return;
    const auto status = child_.wait(at_most);
    const TimePoint now = TimePoint::clock::now();
    silence_.sample(now, false, cpu_wait_.sample(now));
    if (!status && !silence_.is_too_long()) return;
    if (!status) child_.signal(SIGKILL);
    outcome_ = !status ? SafeOutcome::hangs : ended_well(*status) ? SafeOutcome::safe : SafeOutcome::failed;
    is_over_ = true;
  }
  /// If it was killed, and has not ended until then.
  void lose(TimePoint until, std::vector<Child>& lost) {
    if (outcome_ != SafeOutcome::hangs) return;
    const auto left = std::chrono::ceil<milliseconds>(until - TimePoint::clock::now());
    if (!child_.wait(std::max(left, milliseconds(0)))) lost.push_back(std::move(child_));
  }

 private:
  Child child_;
  std::size_t work_;  ///< its number
  SafeOutcome outcome_ = SafeOutcome::unasked;
  CpuWait cpu_wait_;
  Silence silence_;
  bool is_over_ = false;
};

SafetyProcesses::SafetyProcesses(std::vector<Child>& lost) : lost_(lost) {}
SafetyProcesses::~SafetyProcesses() = default;

bool SafetyProcesses::start(const std::function<bool()>& work) {
  outcomes_.push_back(SafeOutcome::unasked);
  auto child = Child::start([&] {
    ::prctl(PR_SET_NAME, "coupler-safety");
    // In case nobody is left to kill it.
    ::alarm(2 * static_cast<unsigned>(Silence::limit_in_any_case.count()));
    return work() ? 0 : 1;
  });
  if (!child) return false;
  processes_.emplace_back(*std::move(child), outcomes_.size() - 1);
  return true;
}

std::vector<SafeOutcome> SafetyProcesses::finish() {
  // One is waited for, and all are looked at meanwhile.
  for (Process& awaited : processes_)
    while (!awaited.is_over()) {
      awaited.look(turn);
      for (Process& each : processes_) each.look(milliseconds(0));
    }
  const TimePoint until = TimePoint::clock::now() + time_to_die;
  for (Process& each : processes_) {
    outcomes_[each.work()] = each.outcome();
    each.lose(until, lost_);
  }
  return outcomes_;
}

}  // namespace coupler::device
