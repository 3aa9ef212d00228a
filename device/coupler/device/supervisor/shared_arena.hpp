// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <memory_resource>
#include <new>

namespace coupler::device {

/// SharedState that a process shares with those that it forks: what one of them builds there stands at the
/// same address in all of them. One at a time allocates. It takes memory only as far as it is used, and
/// nothing is freed before all is.
class SharedArena final : public std::pmr::memory_resource {
 public:
  /// Throws std::bad_alloc like any container; so does an allocation that does not fit in.
  explicit SharedArena(std::size_t size) : size_(size) {
    void* const memory =
        ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    begin_ = static_cast<std::byte*>(memory);
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

  std::byte* begin_ = nullptr;
  std::size_t size_;
};

}  // namespace coupler::device
