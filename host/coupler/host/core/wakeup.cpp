// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/wakeup.hpp"

#include <poll.h>
#include <sys/eventfd.h>

#include <array>
#include <cerrno>
#include <system_error>

namespace coupler::host {
namespace {

int event_descriptor() {
  const int fd = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (fd >= 0) return fd;
  const std::error_code why(errno, std::generic_category());
  if (why != std::errc::too_many_files_open)  // not the limit of this process
    throw std::system_error(why, "a thread could not be woken");
  throw std::system_error(why,
                          "no file descriptor is left to wake a thread; look at the limit (ulimit -n, "
                          "LimitNOFILE= of a service)");
}

}  // namespace

Event::Event() : fd_(event_descriptor()) {}

void Event::set() {
  set_.store(true, std::memory_order_release);
  ::eventfd_write(fd_.get(), 1);
}

Wakeup::Wakeup() : fd_(event_descriptor()) {}

void Wakeup::call() { ::eventfd_write(fd_.get(), 1); }

void Wakeup::clear() {
  eventfd_t calls = 0;
  ::eventfd_read(fd_.get(), &calls);
}

Woken wait_for(Wakeup& wakeup, const Event* interrupted, int socket, Time time) {
  const Time now = std::chrono::steady_clock::now();
  if (time <= now) return Woken::by_time;
  const Duration left = time - now;
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(left);
  const timespec wait{seconds.count(), (left - seconds).count()};
  std::array<pollfd, 3> wanted{{{wakeup.fd(), POLLIN, 0},
                                {interrupted == nullptr ? -1 : interrupted->fd(), POLLIN, 0},
                                {socket, POLLIN, 0}}};
  ::ppoll(wanted.data(), wanted.size(), &wait, nullptr);
  if (wanted[0].revents != 0) wakeup.clear();
  if (wanted[2].revents != 0) return Woken::by_bytes;
  return wanted[0].revents != 0 || wanted[1].revents != 0 ? Woken::by_call : Woken::by_time;
}

}  // namespace coupler::host
