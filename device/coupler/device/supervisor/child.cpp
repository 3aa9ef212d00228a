// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/supervisor/child.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>
#include <utility>
#include <vector>

namespace coupler::device {
namespace {

/// The header of Debian 12's C library for it does not link in C++.
Descriptor open_pidfd(pid_t pid) { return Descriptor(static_cast<int>(::syscall(SYS_pidfd_open, pid, 0))); }

/// An exception must not unwind into the parent's part of the stack.
[[noreturn]] void live_and_exit(const std::function<int()>& live) noexcept { ::_exit(live()); }

}  // namespace

tl::expected<Child, int> Child::start(const std::function<int()>& live) {
  const pid_t pid = ::fork();
  if (pid < 0) return tl::unexpected(errno);
  if (pid == 0) live_and_exit(live);
  Descriptor descriptor = open_pidfd(pid);
  const int error = errno;
  Child child(pid, std::move(descriptor));
  if (!child.descriptor_.is_open()) return tl::unexpected(error);
  return child;
}

Child::Child(Child&& other) noexcept
    : pid_(std::exchange(other.pid_, 0)), descriptor_(std::move(other.descriptor_)) {}

Child& Child::operator=(Child&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

Child::~Child() {
  if (pid_ != 0) (void)kill();
}

void Child::signal(int number) const { ::kill(pid_, number); }

std::optional<int> Child::wait(std::chrono::milliseconds at_most) {
  pollfd end{descriptor_.get(), POLLIN, 0};
  ::poll(&end, 1, static_cast<int>(at_most.count()));
  int status = 0;
  if (::waitpid(pid_, &status, WNOHANG) != pid_) return std::nullopt;
  pid_ = 0;
  return status;
}

std::optional<int> Child::kill() {
  signal(SIGKILL);
  return wait(timeout);
}

std::string describe_end(int status) {
  if (WIFSIGNALED(status))
    return fmt::format("was killed by signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
  return fmt::format("exited with status {}", WEXITSTATUS(status));
}

bool ended_well(int status) { return WIFEXITED(status) && WEXITSTATUS(status) == 0; }

bool end_with_parent(pid_t parent, int signal) {
  ::prctl(PR_SET_PDEATHSIG, signal);
  // It may have ended before the kernel was asked to tell of it.
  return ::getppid() == parent;
}

void close_descriptors(std::initializer_list<int> kept) {
  std::vector<int> sorted(kept);
  std::sort(sorted.begin(), sorted.end());
  auto first = static_cast<unsigned>(STDERR_FILENO) + 1;
  for (const int each : sorted) {
    const auto number = static_cast<unsigned>(each);
    if (each < 0 || number < first) continue;
    if (number > first) ::close_range(first, number - 1, 0);
    first = number + 1;
  }
  ::close_range(first, UINT_MAX, 0);
}

}  // namespace coupler::device
