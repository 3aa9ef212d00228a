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
/// For all that were killed: the kernel takes its time to free what they had.
constexpr milliseconds time_to_die{1000};

tl::expected<Child, int> start(const std::function<bool()>& work) {
  return Child::start([&] {
    ::prctl(PR_SET_NAME, "coupler-safety");
    // In case nobody is left to kill it.
    ::alarm(2 * static_cast<unsigned>(Silence::limit_in_any_case.count()));
    return work() ? 0 : 1;
  });
}

class SafetyProcess {
 public:
  SafetyProcess(Child child, SafeOutcome& outcome)
      : child_(std::move(child)),
        outcome_(&outcome),
        cpu_wait_(child_.pid()),
        silence_(TimePoint::clock::now(), turn, cpu_wait_.sample(TimePoint::clock::now())) {}

  bool is_over() const { return is_over_; }
  /// Waits for its end for so long, and kills it if it takes too long.
  void look(milliseconds at_most) {
    if (is_over_) return;
    const auto status = child_.wait(at_most);
    const TimePoint now = TimePoint::clock::now();
    silence_.sample(now, false, cpu_wait_.sample(now));
    if (!status && !silence_.is_too_long()) return;
    if (!status) child_.signal(SIGKILL);
    *outcome_ = !status ? SafeOutcome::hangs : ended_well(*status) ? SafeOutcome::safe : SafeOutcome::failed;
    is_over_ = true;
  }
  /// If it was killed, and has not ended until then.
  void lose(TimePoint until, std::vector<Child>& lost) {
    if (*outcome_ != SafeOutcome::hangs) return;
    const auto left = std::chrono::ceil<milliseconds>(until - TimePoint::clock::now());
    if (!child_.wait(std::max(left, milliseconds(0)))) lost.push_back(std::move(child_));
  }

 private:
  Child child_;
  SafeOutcome* outcome_;
  CpuWait cpu_wait_;
  Silence silence_;
  bool is_over_ = false;
};

}  // namespace

std::vector<SafeOutcome> drive_apart(const std::vector<std::function<bool()>>& works,
                                     std::vector<Child>& lost) {
  std::vector<SafeOutcome> outcomes(works.size(), SafeOutcome::unasked);
  std::vector<SafetyProcess> processes;
  for (std::size_t i = 0; i < works.size(); ++i)
    if (auto child = start(works[i])) processes.emplace_back(*std::move(child), outcomes[i]);
  // One is waited for, and all are looked at meanwhile.
  for (SafetyProcess& awaited : processes)
    while (!awaited.is_over()) {
      awaited.look(turn);
      for (SafetyProcess& each : processes) each.look(milliseconds(0));
    }
  const TimePoint until = TimePoint::clock::now() + time_to_die;
  for (SafetyProcess& each : processes) each.lose(until, lost);
  return outcomes;
}

}  // namespace coupler::device
