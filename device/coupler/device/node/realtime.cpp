// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/realtime.hpp"

#include <fmt/format.h>
#include <sched.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstddef>
#include <cstring>

namespace coupler::device {
namespace {

// The supervisor's suffices for both.
constexpr int limit = static_cast<int>(RealtimePriority::supervisor);

std::string refusal(const std::string& what, int error, const std::string& setting,
                    const std::string& command) {
  return fmt::format(
      "--realtime: {} is refused: {}; in a service's unit set {} (the drop-in examples/realtime.conf does), "
      "in a shell run '{}' as root first",
      what, std::strerror(error), setting, command);
}

/// A limit that suffices for now would end the node later, when it starts a thread or reads a larger map.
bool more_can_be_locked() {
  constexpr std::size_t some_stacks = 64 << 20;
  void* const memory =
      ::mmap(nullptr, some_stacks, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  return memory != MAP_FAILED && ::munmap(memory, some_stacks) == 0;
}

/// All that there is now is read in; what comes later is locked page by page as it is used. Otherwise each
/// thread that is started would take the whole of its stack from the machine, 8 MiB. The error is an errno.
tl::expected<void, int> lock_memory() {
  if (::mlockall(MCL_CURRENT) != 0 || ::mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) != 0)
    return tl::unexpected(errno);
  if (!more_can_be_locked()) return tl::unexpected(ENOMEM);
  return {};
}

}  // namespace

bool take_priority(RealtimePriority priority) {
  sched_param parameters{};
  parameters.sched_priority = static_cast<int>(priority);
  return ::sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters) == 0;
}

tl::expected<void, std::string> become_realtime(RealtimePriority priority) {
  std::string errors;
  if (!take_priority(priority))
    errors = refusal(fmt::format("SCHED_FIFO with priority {}", static_cast<int>(priority)), errno,
                     fmt::format("LimitRTPRIO={} and RestrictRealtime=no", limit),
                     fmt::format("ulimit -r {}", limit));
  if (const auto locked = lock_memory(); !locked) {
    if (!errors.empty()) errors += '\n';
    errors += refusal("locked memory", locked.error(), "LimitMEMLOCK=infinity", "ulimit -l unlimited");
  }
  if (!errors.empty()) return tl::unexpected(std::move(errors));
  return {};
}

}  // namespace coupler::device
