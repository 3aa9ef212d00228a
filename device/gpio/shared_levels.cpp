// SPDX-License-Identifier: Apache-2.0
#include "device/gpio/shared_levels.hpp"

#include <sys/mman.h>

#include <new>

namespace coupler::node {

SharedLevels::SharedLevels(std::size_t count) {
  if (count == 0) return;
  void* memory =
      ::mmap(nullptr, count * sizeof(int), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  levels_ = Span<int>(static_cast<int*>(memory), count);
}

SharedLevels::~SharedLevels() {
  if (!levels_.empty()) ::munmap(levels_.data(), levels_.size() * sizeof(int));
}

}  // namespace coupler::node
