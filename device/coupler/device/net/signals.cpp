// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/net/signals.hpp"

#include <fcntl.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <cassert>

#include "coupler/base/ending_signals.hpp"

namespace coupler::device {

bool has_terminal() { return Descriptor(::open("/dev/tty", O_RDONLY | O_NOCTTY | O_CLOEXEC)).is_open(); }

Signals::Signals(Loop& loop) : loop_(loop), has_terminal_(has_terminal()) {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  sigaddset(&signals_, SIGTSTP);
  if (!is_ignored(SIGHUP)) sigaddset(&signals_, SIGHUP);
  ::sigprocmask(SIG_BLOCK, &signals_, &blocked_before_);
  std::signal(SIGPIPE, SIG_IGN);
  descriptor_ = Descriptor(::signalfd(-1, &signals_, SFD_NONBLOCK | SFD_CLOEXEC));
  [[maybe_unused]] const bool watched = loop_.watch(descriptor_.get(), Interest::read, *this);
  assert(watched);
}

Signals::~Signals() {
  loop_.forget(descriptor_.get(), *this);
  ::sigprocmask(SIG_SETMASK, &blocked_before_, nullptr);
}

void Signals::ready(TimePoint) {
  signalfd_siginfo info{};
  if (::read(descriptor_.get(), &info, sizeof info) != sizeof info) return;
  if (info.ssi_signo == SIGTSTP)
    suspend_ = true;
  else if (info.ssi_signo == SIGHUP && (!has_terminal_ || has_terminal()))
    reload_ = static_cast<pid_t>(info.ssi_pid);
  else
    stop_ = static_cast<int>(info.ssi_signo);
}

}  // namespace coupler::device
