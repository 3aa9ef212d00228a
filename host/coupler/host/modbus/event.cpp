// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/event.hpp"

#include <sys/eventfd.h>

namespace coupler::host {

Event::Event() : fd_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}

void Event::set() {
  set_.store(true, std::memory_order_release);
  ::eventfd_write(fd_.get(), 1);
}

}  // namespace coupler::host
