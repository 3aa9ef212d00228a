// SPDX-License-Identifier: Apache-2.0
// What both ends of the line need.
#pragma once

#include <termios.h>
#include <time.h>  // NOLINT(modernize-deprecated-headers): clock_nanosleep

#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace coupler::bench {

constexpr std::int64_t second = 1'000'000'000;

/// ns of CLOCK_MONOTONIC.
inline std::int64_t now() {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return time.tv_sec * second + time.tv_nsec;
}

inline void sleep_until(std::int64_t at) {
  const timespec when{at / second, at % second};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &when, nullptr) != 0) {
  }
}

[[noreturn]] inline void give_up(const char* what) {
  std::perror(what);
  std::exit(1);
}

/// Bytes pass as they are.
inline void make_raw(int port) {
  termios raw{};
  if (::tcgetattr(port, &raw) != 0) give_up("tcgetattr");
  ::cfmakeraw(&raw);
  if (::tcsetattr(port, TCSANOW, &raw) != 0) give_up("tcsetattr");
}

}  // namespace coupler::bench
