// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>

#include "coupler/host/ros/program.hpp"
#include "coupler/host/ros/shutdown.hpp"

namespace coupler::host {
namespace {

[[noreturn]] void fail() { throw std::runtime_error("no memory for a topic"); }

/// A driver whose thread fails; returns what its main thread then finds, once the thread has said why: it
/// requests the shutdown before that.
void drive_with_a_thread_that_fails() {
  int said[2];
  const int standard_error = ::dup(STDERR_FILENO);
  if (::pipe(said) != 0 || ::dup2(said[1], STDERR_FILENO) < 0) ::_exit(9);
  end_safely_on_uncaught_exceptions();
  Shutdown::begin_driving();
  std::thread([] { fail(); }).detach();
  while (!Shutdown::requested) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  char text[200];
  const ssize_t size = ::read(said[0], text, sizeof text);
  if (size < 0 || ::write(standard_error, text, static_cast<std::size_t>(size)) != size) ::_exit(9);
  ::_exit(Shutdown::has_failed_thread ? 7 : 8);
}

TEST(UncaughtException, Of_a_thread_is_told_and_requests_the_shutdown) {
  EXPECT_EXIT(drive_with_a_thread_that_fails(), testing::ExitedWithCode(7),
              "coupler_driver: a thread has failed: no memory for a topic");
}

TEST(UncaughtException, Of_the_main_thread_or_before_anything_is_driven_ends_the_program) {
  EXPECT_EXIT(
      {
        end_safely_on_uncaught_exceptions();
        std::thread([] { fail(); }).join();
      },
      testing::KilledBySignal(SIGABRT), "a thread has failed: no memory");
}

}  // namespace
}  // namespace coupler::host
