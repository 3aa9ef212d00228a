// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/shutdown.hpp"

#include <unistd.h>

#include <csignal>

#include "coupler/base/ending_signals.hpp"

namespace coupler::host {
namespace {

enum class Stage { starting, exiting, driving, ending };
std::atomic<Stage> stage{Stage::starting};

// These belong to the last stage, and are set before it begins.
std::atomic<std::chrono::steady_clock::rep> patient_until{0};  // of ticks()
std::atomic<int> end_code{0};

auto ticks() { return std::chrono::steady_clock::now().time_since_epoch().count(); }

void on_signals(void (*handler)(int)) {
  on_ending_signals(handler);
  std::signal(SIGALRM, handler);
}

/// Nothing has to be done at the end.
[[noreturn]] void exit_at_once(int signal, int exit_code) {
  if (signal == SIGQUIT) die_of(signal);
  ::_exit(exit_code);
}

}  // namespace

std::atomic<bool> Shutdown::requested{false};
std::atomic<bool> Shutdown::has_failed_thread{false};

void Shutdown::begin_driving() {
  Stage now = Stage::starting;
  if (stage.compare_exchange_strong(now, Stage::driving) || now != Stage::exiting) return;
  for (;;) ::pause();
}

void Shutdown::begin_to_end(int exit_code, std::chrono::seconds patience) {
  begin_driving();  // a signal may be exiting
  end_code = exit_code;
  patient_until = ticks() + std::chrono::steady_clock::duration(patience).count();
  stage = Stage::ending;
}

bool Shutdown::is_driving() { return stage == Stage::driving; }

void Shutdown::exit_on_signals() {
  on_signals([](int signal) { exit_at_once(signal, 0); });
}

void Shutdown::unregister_on_signals(void (*shut_down)()) {
  static std::atomic<void (*)()> first{nullptr};
  first = shut_down;
  on_signals([](int signal) {
    if (signal == SIGQUIT) core_is_wanted = true;
    const auto unregister = first.exchange(nullptr);
    if (unregister == nullptr) exit_at_once(signal, 0);
    unregister();
  });
}

void Shutdown::request_on_signals() {
  on_signals([](int signal) {
    if (signal == SIGQUIT) core_is_wanted = true;
    Stage now = Stage::starting;
    if (requested.exchange(true) && stage.compare_exchange_strong(now, Stage::exiting))
      exit_at_once(signal, 0);
    if (stage == Stage::ending && ticks() >= patient_until) exit_at_once(signal, end_code);
  });
}

}  // namespace coupler::host
