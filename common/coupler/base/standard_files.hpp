// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

namespace coupler {

/// Opens /dev/null as stdin, stdout and stderr where they are closed. The kernel gives a new file the lowest
/// free number: without this, a program that was started with `2>&-` would write its log into its first
/// socket or GPIO chip. To be called before anything is opened.
inline void open_standard_files() {
  for (int file = STDIN_FILENO; file <= STDERR_FILENO; ++file) {
    if (::fcntl(file, F_GETFD) != -1 || errno != EBADF) continue;
    // The files below are open: this is the lowest free number. To go on without it would be dangerous.
    if (::open("/dev/null", O_RDWR) != file) std::abort();
  }
}

}  // namespace coupler
