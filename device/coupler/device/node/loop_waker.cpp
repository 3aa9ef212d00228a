// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/loop_waker.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <cstdint>

namespace coupler::device {

LoopWaker::LoopWaker(Loop& loop) : event_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (event_.is_open() && !loop.watch(event_.get(), Interest::read, *this)) event_.close();
}

void LoopWaker::wake() {
  const std::uint64_t one = 1;
  // A counter that is full wakes as well.
  if (event_.is_open()) (void)!::write(event_.get(), &one, sizeof one);
}

void LoopWaker::ready(TimePoint) {
  std::uint64_t count = 0;
  (void)!::read(event_.get(), &count, sizeof count);
}

}  // namespace coupler::device
