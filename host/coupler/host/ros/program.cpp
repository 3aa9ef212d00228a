// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/program.hpp"

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>

#include <fmt/format.h>

#include "coupler/base/standard_files.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::host {
namespace {

enum class Stage { starting, exiting, driving, ending };
std::atomic<Stage> stage{Stage::starting};

// Of the last one; set before it begins.
std::chrono::steady_clock::rep patient_until = 0;  // of ticks()
int end_code = 0;

auto ticks() { return std::chrono::steady_clock::now().time_since_epoch().count(); }

void on_signals(void (*handler)(int)) {
  std::signal(SIGINT, handler);
  std::signal(SIGTERM, handler);
}

}  // namespace

std::atomic<bool> Shutdown::requested{false};

void Shutdown::begin_driving() {
  Stage now = Stage::starting;
  if (stage.compare_exchange_strong(now, Stage::driving) || now != Stage::exiting) return;
  for (;;) ::pause();
}

void Shutdown::outputs_are_safe(int exit_code) {
  begin_driving();  // a signal may be exiting
  patient_until = ticks() + std::chrono::steady_clock::duration(std::chrono::seconds(2)).count();
  end_code = exit_code;
  stage = Stage::ending;
}

bool Shutdown::is_driving() { return stage == Stage::driving; }

void Shutdown::exit_on_signals() {
  on_signals([](int) { ::_exit(0); });
}

void Shutdown::request_on_signals() {
  on_signals([](int) {
    Stage now = Stage::starting;
    if (requested.exchange(true) && stage.compare_exchange_strong(now, Stage::exiting)) ::_exit(0);
    if (stage == Stage::ending && ticks() >= patient_until) ::_exit(end_code);
  });
}

void begin_program() {
  open_standard_files();
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // ROS's log is to be seen in a pipe and in the journal too
  Shutdown::exit_on_signals();
}

int end_of(const Options& arguments) {
  fmt::print(*arguments.exit_code == 0 ? stdout : stderr, "{}", arguments.text);
  return *arguments.exit_code;
}

void print_message(std::string_view text) {
  fmt::print(stderr, "coupler_driver: {}\n", printable_lines(text));
}

}  // namespace coupler::host
