// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <new>

namespace coupler::node {

/// Room that a process shares with those that it forks: what one of them builds there stands at the same
/// address in all of them. It takes memory only as far as it is used.
class SharedArena {
 public:
  /// Throws std::bad_alloc like any container.
  explicit SharedArena(std::size_t size)
      : begin_(
            ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0)),
        size_(size) {
    if (begin_ == MAP_FAILED) throw std::bad_alloc();
  }
  SharedArena(const SharedArena&) = delete;
  SharedArena& operator=(const SharedArena&) = delete;
  ~SharedArena() { ::munmap(begin_, size_); }

  void* begin() const { return begin_; }
  std::size_t size() const { return size_; }

 private:
  void* begin_;
  std::size_t size_;
};

}  // namespace coupler::node
