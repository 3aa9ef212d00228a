// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/log_stream.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <termios.h>

#include <climits>

namespace coupler::device {
namespace {

Descriptor open_at_once(const char* path) {
  return Descriptor(::open(path, O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
}

/// Opened again, it has flags of its own. Not a file: it would also have a position of its own, and whoever
/// writes to the file as well would overwrite the log. /dev/stderr is refused if the pipe or terminal is
/// another user's; the terminal of one's own session never is.
Descriptor open_again(mode_t kind) {
  if (!S_ISFIFO(kind) && !S_ISCHR(kind)) return {};
  Descriptor own = open_at_once("/proc/self/fd/2");
  if (!own.is_open() && ::tcgetsid(STDERR_FILENO) == ::getsid(0)) own = open_at_once("/dev/tty");
  return own;
}

bool takes_some(int fd) {
  pollfd wish{fd, POLLOUT, 0};
  return ::poll(&wish, 1, 0) == 1 && (wish.revents & POLLOUT) != 0;
}

}  // namespace

LogStream::LogStream() {
  struct stat now {};
  if (::fstat(STDERR_FILENO, &now) != 0) return;
  is_socket_ = S_ISSOCK(now.st_mode);
  own_ = open_again(now.st_mode);
}

std::size_t LogStream::write(std::string_view text) const {
  std::size_t written = 0;
  while (written < text.size()) {
    const std::size_t more = write_some(text.substr(written, PIPE_BUF));
    if (more == 0) break;
    written += more;
  }
  return written;
}

/// A pipe that poll() calls writable has room for PIPE_BUF bytes (pipe(7): a whole page is free).
std::size_t LogStream::write_some(std::string_view text) const {
  ssize_t written = -1;
  if (is_socket_)
    written = ::send(STDERR_FILENO, text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  else if (own_.is_open())
    written = ::write(own_.get(), text.data(), text.size());
  else if (takes_some(STDERR_FILENO))
    written = ::write(STDERR_FILENO, text.data(), text.size());
  return written > 0 ? static_cast<std::size_t>(written) : 0;
}

}  // namespace coupler::device
