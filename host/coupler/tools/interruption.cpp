// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/interruption.hpp"

#include <pthread.h>

#include <chrono>
#include <utility>

#include "coupler/base/ending_signals.hpp"

namespace coupler::tools {
namespace {

/// The first signal may come twice: from the terminal, and passed on by what started the program.
constexpr std::chrono::milliseconds same_wish{500};

/// Sent by nobody else.
int end_of_the_wait() { return SIGRTMIN; }

sigset_t awaited_signals() {
  sigset_t signals{};
  sigemptyset(&signals);
  sigaddset(&signals, end_of_the_wait());
  for (const int signal : ending_signals)
    if (!is_ignored(signal)) sigaddset(&signals, signal);
  return signals;
}

}  // namespace

Interruption::Interruption(std::function<void()> call) {
  const sigset_t signals = awaited_signals();
  pthread_sigmask(SIG_BLOCK, &signals, &before_);
  thread_ = std::thread([this, signals, call = std::move(call)] {
    int signal = 0;
    sigwait(&signals, &signal);
    if (unwanted_) return;
    signal_ = signal;
    if (signal == SIGQUIT) core_is_wanted = true;
    call();
    const auto called = std::chrono::steady_clock::now();
    do sigwait(&signals, &signal);
    while (!unwanted_ && std::chrono::steady_clock::now() - called < same_wish);
    if (!unwanted_) die_of(signal);
  });
}

Interruption::~Interruption() {
  unwanted_ = true;
  pthread_kill(thread_.native_handle(), end_of_the_wait());
  thread_.join();
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

}  // namespace coupler::tools
