// SPDX-License-Identifier: Apache-2.0
#include "device/net/signals.hpp"

#include <sys/signalfd.h>
#include <unistd.h>

#include <cassert>
#include <csignal>

namespace coupler::node {
namespace {

sigset_t stopping() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&set, signal);
  return set;
}

}  // namespace

Signals::Signals(Loop& loop) : loop_(loop) {
  const sigset_t set = stopping();
  ::sigprocmask(SIG_BLOCK, &set, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  descriptor_ = Descriptor(::signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC));
  [[maybe_unused]] const bool watched = loop_.watch(descriptor_.get(), Interest::read, *this);
  assert(watched);
}

Signals::~Signals() {
  loop_.forget(descriptor_.get(), *this);
  const sigset_t set = stopping();
  ::sigprocmask(SIG_UNBLOCK, &set, nullptr);
}

void Signals::ready(TimePoint) {
  signalfd_siginfo info{};
  if (::read(descriptor_.get(), &info, sizeof info) == sizeof info) stop_ = static_cast<int>(info.ssi_signo);
}

}  // namespace coupler::node
