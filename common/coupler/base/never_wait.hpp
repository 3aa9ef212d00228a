// SPDX-License-Identifier: Apache-2.0
// No thread waits for whoever reads the log.
#pragma once

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>
#include <thread>

namespace coupler {

/// Opened again, a pipe or terminal has flags of its own: other programs that use it see no difference. -1:
/// it cannot be. /proc/self/fd/N is refused if it is another user's; the terminal of one's own session never
/// is. Not a file: it would also have a position of its own, and nobody makes a writer of a file wait.
inline int open_again(int file) {
  constexpr int flags = O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;
  struct stat now {};
  if (::fstat(file, &now) != 0 || (!S_ISFIFO(now.st_mode) && !S_ISCHR(now.st_mode))) return -1;
  const int own = ::open(("/proc/self/fd/" + std::to_string(file)).c_str(), flags);
  return own != -1 || ::tcgetsid(file) != ::getsid(0) ? own : ::open("/dev/tty", flags);
}

namespace detail {

/// Carries what is written into a pipe on to its reader, who may let it wait: a thread that has nothing else
/// to do.
class Forwarder {
 public:
  Forwarder(int from, int to) : from_(from), to_(to) {
    sigset_t all{};
    sigset_t before{};
    sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);
    std::thread([this] { forward(); }).detach();
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }

  /// Returns when the reader has what was written so far, or has had a fifth of a second for it.
  void drain() const {
    for (int i = 0; i < 200; ++i) {
      int left = 0;
      if (::ioctl(from_, FIONREAD, &left) != 0 || (left == 0 && !is_writing_)) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

 private:
  void forward() {
    std::array<char, 4096> text{};
    for (;;) {
      is_writing_ = false;
      const ssize_t size = ::read(from_, text.data(), text.size());
      if (size <= 0) return;
      is_writing_ = true;
      for (ssize_t done = 0; done < size;) {
        const ssize_t some = ::write(to_, text.data() + done, static_cast<std::size_t>(size - done));
        if (some <= 0) break;  // nobody reads any more
        done += some;
      }
    }
  }

  int from_;
  int to_;
  std::atomic<bool> is_writing_{false};
};

inline std::array<std::atomic<const Forwarder*>, 3> forwarders{};

/// Serves what cannot be opened again: a socket, or a pipe of another user.
inline void forward_by_thread(int file) {
  std::array<int, 2> pipe{};
  const int reader = ::fcntl(file, F_DUPFD_CLOEXEC, 3);
  if (reader == -1 || ::pipe2(pipe.data(), O_CLOEXEC) != 0) return;
  ::fcntl(pipe[1], F_SETFL, O_NONBLOCK);
  ::dup2(pipe[1], file);
  ::close(pipe[1]);
  forwarders.at(static_cast<std::size_t>(file)) = new Forwarder(pipe[0], reader);  // as long as the process
  [[maybe_unused]] static const int registered = std::atexit([] {
    for (const auto& each : forwarders)
      if (const Forwarder* forwarder = each) forwarder->drain();
  });
}

}  // namespace detail

/// From now on nothing that this process writes to standard output or standard error (`file`), through
/// whichever library, waits for its reader: a terminal that was stopped by Ctrl-S, a pipe that is full, a log
/// collector that hangs. What cannot be written at once is dropped. To be called before any other thread
/// writes.
inline void never_wait_for_reader_of(int file) {
  // A terminal with "stty tostop" stops a process of the background that writes, and a file that may not grow
  // ends it.
  std::signal(SIGTTOU, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  struct stat now {};
  if (::fstat(file, &now) != 0 || S_ISREG(now.st_mode)) return;
  const int own = open_again(file);
  if (own == -1) return S_ISCHR(now.st_mode) ? void() : detail::forward_by_thread(file);
  ::dup2(own, file);
  ::close(own);
}

}  // namespace coupler
