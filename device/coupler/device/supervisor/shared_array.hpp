// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

#include "coupler/base/span.hpp"

namespace coupler::device {

/// SharedState that a process shares with those that it forks: what one of them leaves behind when it dies,
/// the next one finds.
template <class T>
class SharedArray {
  static_assert(std::is_trivially_destructible_v<T>, "nobody knows which process is the last");

 public:
  /// Throws std::bad_alloc like any container.
  explicit SharedArray(std::size_t count) : all_(shared(count)) {
    std::uninitialized_value_construct(all_.begin(), all_.end());
  }
  SharedArray(std::size_t count, const T& value) : all_(shared(count)) {
    std::uninitialized_fill(all_.begin(), all_.end(), value);
  }
  /// Copies of them.
  explicit SharedArray(Span<const T> values) : all_(shared(values.size())) {
    std::uninitialized_copy(values.begin(), values.end(), all_.begin());
  }
  SharedArray(const SharedArray&) = delete;
  SharedArray& operator=(const SharedArray&) = delete;
  ~SharedArray() {
    if (!all_.empty()) ::munmap(all_.data(), all_.size() * sizeof(T));
  }

  Span<T> all() const { return all_; }
  T& operator[](std::size_t i) const { return all_[i]; }

 private:
  static Span<T> shared(std::size_t count) {
    if (count == 0) return {};
    void* memory =
        ::mmap(nullptr, count * sizeof(T), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    return Span<T>(static_cast<T*>(memory), count);
  }

  Span<T> all_;
};

}  // namespace coupler::device
