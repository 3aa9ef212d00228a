// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/cli/interruption.hpp"

#include <pthread.h>

#include <utility>

namespace coupler::cli {

Interruption::Interruption(std::function<void()> call) {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, &before_);
  thread_ = std::thread([this, signals, call = std::move(call)] {
    int signal = 0;
    sigwait(&signals, &signal);
    if (!unwanted_) call();
  });
}

Interruption::~Interruption() {
  unwanted_ = true;
  pthread_kill(thread_.native_handle(), SIGINT);  // ends sigwait(), if nothing has
  thread_.join();
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

}  // namespace coupler::cli
