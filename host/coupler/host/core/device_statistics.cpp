// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/device_statistics.hpp"

namespace coupler::host {

void DeviceStatistics::wrote(WriteResult::Outcome outcome) {
  const std::lock_guard lock(mutex_);
  ++now_.writes[static_cast<std::size_t>(outcome)];
}

void DeviceStatistics::cycle_ended(Duration after, std::uint64_t overruns) {
  const std::lock_guard lock(mutex_);
  now_.cycles.add(after);
  now_.overruns = overruns;
}

void DeviceStatistics::rejected() {
  const std::lock_guard lock(mutex_);
  ++now_.rejected_ranges;
}

void DeviceStatistics::heard(std::uint64_t changes, std::uint64_t lost) {
  const std::lock_guard lock(mutex_);
  now_.changes += changes;
  now_.changes_lost += lost;
}

void DeviceStatistics::watchdog(const WatchdogStatus& status) {
  const std::lock_guard lock(mutex_);
  now_.watchdog = status;
}

void DeviceStatistics::identified(Identity::Verdict verdict, const identity::Machine& machine) {
  const std::lock_guard lock(mutex_);
  now_.identity = verdict;
  now_.machine = machine;
  ++revision_;
}

void DeviceStatistics::online(const std::optional<Certificates>& certificates) {
  const std::lock_guard lock(mutex_);
  now_.certificates = certificates;
  now_.online = true;
  now_.trouble.clear();
  ++now_.connections;
  ++revision_;
}

void DeviceStatistics::offline(const std::string& trouble) {
  const std::lock_guard lock(mutex_);
  now_.online = false;
  now_.trouble = trouble;
  ++revision_;
}

DeviceCounts DeviceStatistics::counts() const {
  const std::lock_guard lock(mutex_);
  return now_;
}

}  // namespace coupler::host
