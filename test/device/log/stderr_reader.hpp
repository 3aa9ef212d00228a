// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <string>
#include <utility>

#include "coupler/base/descriptor.hpp"

namespace coupler::device {

/// Stands in the place of whoever reads this process's stderr, and reads when it wants.
class StderrReader {
 public:
  static StderrReader of_pipe() {
    std::array<int, 2> ends{};
    EXPECT_EQ(::pipe2(ends.data(), O_CLOEXEC), 0);
    return {Descriptor(ends[0]), Descriptor(ends[1])};
  }
  static StderrReader of_socket() {
    std::array<int, 2> ends{};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()), 0);
    return {Descriptor(ends[0]), Descriptor(ends[1])};
  }
  static StderrReader of_terminal() {
    Descriptor screen(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC));
    EXPECT_EQ(::grantpt(screen.get()), 0);
    EXPECT_EQ(::unlockpt(screen.get()), 0);
    Descriptor terminal(::open(::ptsname(screen.get()), O_RDWR | O_NOCTTY | O_CLOEXEC));
    termios settings{};
    EXPECT_EQ(::tcgetattr(terminal.get(), &settings), 0);
    settings.c_oflag &= ~tcflag_t{ONLCR};
    EXPECT_EQ(::tcsetattr(terminal.get(), TCSANOW, &settings), 0);
    return {std::move(screen), std::move(terminal)};
  }
  StderrReader(const StderrReader&) = delete;
  StderrReader& operator=(const StderrReader&) = delete;
  ~StderrReader() { ::dup2(before_.get(), STDERR_FILENO); }

  /// All that came until now, and what a terminal still has on its way.
  std::string read() const {
    std::string all;
    std::array<char, 4096> some{};
    for (pollfd wish{end_.get(), POLLIN, 0}; ::poll(&wish, 1, quiet_ms) > 0;) {
      const ssize_t size = ::read(end_.get(), some.data(), some.size());
      if (size <= 0) break;
      all.append(some.data(), static_cast<std::size_t>(size));
    }
    return all;
  }

 private:
  StderrReader(Descriptor end, Descriptor stderr_end)
      : end_(std::move(end)), stderr_end_(std::move(stderr_end)) {
    EXPECT_EQ(::dup2(stderr_end_.get(), STDERR_FILENO), STDERR_FILENO);
  }

  static constexpr int quiet_ms = 300;

  Descriptor before_{::dup(STDERR_FILENO)};
  Descriptor end_;
  Descriptor stderr_end_;
};

}  // namespace coupler::device
