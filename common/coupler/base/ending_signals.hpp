// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>

namespace coupler {

/// The signals that ask a program to end: Ctrl-C, kill, a closed terminal, Ctrl-\, and those that nobody uses
/// for anything else here. Without a handler each of them would end it at once.
constexpr std::array<int, 6> ending_signals{SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2};

inline bool is_ignored(int signal) {
  struct sigaction action {};
  return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

/// Handles each of ending_signals but those that the program's starter has it ignore, as nohup does with
/// SIGHUP.
inline void on_ending_signals(void (*handler)(int)) {
  for (const int signal : ending_signals)
    if (!is_ignored(signal)) std::signal(signal, handler);
}

/// Ends the process as the signal would have without a handler: SIGQUIT leaves a core.
[[noreturn]] inline void die_of(int signal) {
  std::signal(signal, SIG_DFL);
  sigset_t only{};
  sigemptyset(&only);
  sigaddset(&only, signal);
  ::pthread_sigmask(SIG_UNBLOCK, &only, nullptr);
  ::raise(signal);
  std::abort();
}

/// Set by whoever takes SIGQUIT: the program leaves a core when it has ended in order.
inline std::atomic<bool> core_is_wanted{false};

/// main() returns this, once all that has to be done at the end is done.
inline int end_with(int exit_code) {
  if (core_is_wanted) die_of(SIGQUIT);
  return exit_code;
}

}  // namespace coupler
