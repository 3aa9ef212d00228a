// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/modbus/descriptor.hpp"

namespace coupler::driver {

/// Something that happens once and that poll() can wait for. Any thread may set it.
class Event {
 public:
  Event();
  void set();
  bool is_set() const;
  /// Readable from set() on.
  int fd() const { return fd_.get(); }

 private:
  Descriptor fd_;
};

}  // namespace coupler::driver
