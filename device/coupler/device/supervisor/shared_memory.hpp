// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <memory>
#include <memory_resource>
#include <new>
#include <type_traits>

#include "coupler/base/span.hpp"

namespace coupler::device {

/// Maps memory that this process and those that it forks share. Throws std::bad_alloc like any container.
inline void* map_shared(std::size_t size, int flags = 0) {
  void* const memory =
      ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | flags, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  return memory;
}

/// Values in memory that a process shares with those that it forks: what one of them leaves behind when it
/// dies, the next one finds.
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
    return Span<T>(static_cast<T*>(map_shared(count * sizeof(T))), count);
  }

  Span<T> all_;
};

/// A heap that a process shares with those that it forks: what one of them builds there is at the same
/// address in all of them. Only one of them may allocate at a time. It takes memory only as far as it is
/// used, and frees all of it at once, at its end.
class SharedArena final : public std::pmr::memory_resource {
 public:
  /// Throws std::bad_alloc like any container; so does an allocation that does not fit in.
  explicit SharedArena(std::size_t size)
      : begin_(static_cast<std::byte*>(map_shared(size, MAP_NORESERVE))), size_(size) {
    used() = sizeof(std::size_t);
  }
  SharedArena(const SharedArena&) = delete;
  SharedArena& operator=(const SharedArena&) = delete;
  ~SharedArena() override { ::munmap(begin_, size_); }

  /// Keeps what is used; there is room for nothing more.
  void give_back_rest() {
    const std::size_t kept = round_up(used(), static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)));
    if (kept < size_) ::munmap(begin_ + kept, size_ - kept);
    size_ = kept;
  }

 private:
  static std::size_t round_up(std::size_t size, std::size_t to) { return (size + to - 1) / to * to; }
  /// Its own first bytes included; all processes know it.
  std::size_t& used() const { return *reinterpret_cast<std::size_t*>(begin_); }

  void* do_allocate(std::size_t bytes, std::size_t alignment) override {
    const std::size_t first = round_up(used(), alignment);
    if (first > size_ || bytes > size_ - first) throw std::bad_alloc();
    used() = first + bytes;
    return begin_ + first;
  }
  void do_deallocate(void*, std::size_t, std::size_t) override {}
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override { return this == &other; }

  std::byte* begin_;
  std::size_t size_;
};

}  // namespace coupler::device
