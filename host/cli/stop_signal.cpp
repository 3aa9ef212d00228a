// SPDX-License-Identifier: Apache-2.0
#include "host/cli/stop_signal.hpp"

#include <utility>

namespace coupler::cli {

StopSignal::StopSignal(std::function<void()> on_stop) {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  thread_ = std::thread([this, on_stop = std::move(on_stop)] {
    int which = 0;
    sigwait(&signals_, &which);
    come_ = true;
    on_stop();
  });
}

StopSignal::~StopSignal() {
  if (!come_) pthread_kill(thread_.native_handle(), SIGINT);
  thread_.join();
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

}  // namespace coupler::cli
