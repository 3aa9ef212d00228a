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

enum class Stage { starting, exiting, driving, ending };
std::atomic<Stage> stage{Stage::starting};

// Of the last one; set before it begins.
std::atomic<std::chrono::steady_clock::rep> patient_until{0};  // of ticks()
std::atomic<int> end_code{0};

auto ticks() { return std::chrono::steady_clock::now().time_since_epoch().count(); }

void on_signals(void (*handler)(int)) {
  for (const int number : {SIGINT, SIGTERM, SIGALRM}) std::signal(number, handler);
}

}  // namespace

std::atomic<bool> Shutdown::requested{false};

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
