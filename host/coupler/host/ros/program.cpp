// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/program.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdio>

#include <fmt/format.h>

#include "coupler/base/standard_files.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::host {
namespace {

enum class Stage { starting, driving, exiting };
std::atomic<Stage> stage{Stage::starting};

void on_signals(void (*handler)(int)) {
  std::signal(SIGINT, handler);
  std::signal(SIGTERM, handler);
}

}  // namespace

std::atomic<bool> Shutdown::requested{false};

void Shutdown::begin_driving() {
  Stage now = Stage::starting;
  if (stage.compare_exchange_strong(now, Stage::driving) || now == Stage::driving) return;
  for (;;) ::pause();
}

bool Shutdown::is_driving() { return stage == Stage::driving; }

void Shutdown::exit_on_signals() {
  on_signals([](int) { ::_exit(0); });
}

void Shutdown::request_on_signals() {
  on_signals([](int) {
    Stage now = Stage::starting;
    if (requested.exchange(true) && stage.compare_exchange_strong(now, Stage::exiting)) ::_exit(0);
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
