// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/supervisor/safety.hpp"

#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <optional>

namespace coupler::device {
namespace {

constexpr auto name = "coupler-safety";

/// Ends by itself, too, should nobody be left to kill it.
std::optional<Child> start(const std::function<bool()>& work) {
  auto child = Child::start([&] {
    ::prctl(PR_SET_NAME, name);
    ::alarm(2 * static_cast<unsigned>(safety_timeout.count()));
    return work() ? 0 : 1;
  });
  return child ? std::optional(*std::move(child)) : std::nullopt;
}

bool finish(Child child, TimePoint deadline, std::vector<Child>& lost) {
  using std::chrono::milliseconds;
  const auto left = std::chrono::ceil<milliseconds>(deadline - TimePoint::clock::now());
  if (const auto status = child.wait(std::max(left, milliseconds(0)))) return ended_well(*status);
  if (!child.kill()) lost.push_back(std::move(child));
  return false;
}

}  // namespace

bool make_safe(Workload& workload, bool firmware_too, std::vector<Child>& lost) {
  auto hardware = start([&] { return workload.drive_safe(); });
  bool safe = hardware || workload.drive_safe();
  std::optional<Child> firmware;
  if (firmware_too && workload.has_firmware()) {
    firmware = start([&] { return workload.make_firmware_safe(); });
    safe &= firmware.has_value();
  }
  const TimePoint deadline = TimePoint::clock::now() + safety_timeout;
  if (hardware) safe &= finish(*std::move(hardware), deadline, lost);
  if (firmware) safe &= finish(*std::move(firmware), deadline, lost);
  return safe;
}

}  // namespace coupler::device
