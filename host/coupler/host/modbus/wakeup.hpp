// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/eventfd.h>

#include "coupler/host/modbus/descriptor.hpp"

namespace coupler::host {

/// Lets any thread end the poll() of another, now or the next time.
class Wakeup {
 public:
  Wakeup() : fd_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}
  void call() { ::eventfd_write(fd_.get(), 1); }
  /// What was called so far has been heard.
  void clear() {
    eventfd_t calls = 0;
    ::eventfd_read(fd_.get(), &calls);
  }
  int fd() const { return fd_.get(); }

 private:
  Descriptor fd_;
};

}  // namespace coupler::host
