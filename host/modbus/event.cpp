// SPDX-License-Identifier: Apache-2.0
#include "host/modbus/event.hpp"

#include <poll.h>
#include <sys/eventfd.h>

namespace coupler::driver {

Event::Event() : fd_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}

void Event::set() { ::eventfd_write(fd_.get(), 1); }

bool Event::is_set() const {
  pollfd wanted{fd_.get(), POLLIN, 0};
  return ::poll(&wanted, 1, 0) == 1;
}

}  // namespace coupler::driver
