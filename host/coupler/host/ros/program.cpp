// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/program.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include <fmt/format.h>

#include "coupler/base/never_wait.hpp"
#include "coupler/base/standard_files.hpp"
#include "coupler/base/what_failed.hpp"
#include "coupler/host/ros/shutdown.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::host {
namespace {

std::string what_was_thrown() {
  const auto thrown = std::current_exception();
  return thrown ? what_failed(thrown) : "no exception";
}

}  // namespace

void begin_program() {
  open_standard_files();
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // ROS's log is to be seen in a pipe and in the journal too
  Shutdown::exit_on_signals();
}

void never_wait_for_readers() {
  std::signal(SIGPIPE, SIG_IGN);
  for (const int file : {STDOUT_FILENO, STDERR_FILENO}) never_wait_for_reader_of(file);
}

void end_safely_on_uncaught_exceptions() {
  std::set_terminate([] {
    const bool is_first = !Shutdown::has_failed_thread.exchange(true);
    const bool ends_in_order = Shutdown::is_driving() && ::gettid() != ::getpid();
    if (ends_in_order) Shutdown::requested = true;  // first: there may be no memory for a message
    try {
      if (is_first) print_message("a thread has failed: " + what_was_thrown());
    } catch (...) {
      std::fputs("coupler_driver: a thread has failed\n", stderr);
    }
    if (!ends_in_order) std::abort();
    for (;;) ::pause();
  });
}

int end_of(const Options& arguments) {
  fmt::print(*arguments.exit_code == 0 ? stdout : stderr, "{}", arguments.text);
  return *arguments.exit_code;
}

void print_message(std::string_view text) {
  std::fputs(fmt::format("coupler_driver: {}\n", printable_lines(text)).c_str(), stderr);
}

}  // namespace coupler::host
