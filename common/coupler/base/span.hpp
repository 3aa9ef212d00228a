// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <cstddef>
#include <iterator>
#include <type_traits>

namespace coupler {

/// A view of `size` consecutive elements; it owns nothing. What std::span is from C++20 on.
template <class T>
class Span {
 public:
  constexpr Span() = default;
  constexpr Span(T* data, std::size_t size) : data_(data), size_(size) {}
  template <std::size_t N>
  constexpr Span(T (&array)[N]) : data_(array), size_(N) {}
  /// From any container with data() and size(): vector, array, string, another Span.
  template <class C,
            class = std::enable_if_t<std::is_convertible_v<decltype(std::data(std::declval<C&>())), T*>>>
  constexpr Span(C&& container) : data_(std::data(container)), size_(std::size(container)) {}

  constexpr T* data() const { return data_; }
  constexpr std::size_t size() const { return size_; }
  constexpr bool empty() const { return size_ == 0; }
  constexpr T* begin() const { return data_; }
  constexpr T* end() const { return data_ + size_; }
  constexpr T& front() const { return (*this)[0]; }
  constexpr T& back() const { return (*this)[size_ - 1]; }
  constexpr T& operator[](std::size_t i) const {
    assert(i < size_);
    return data_[i];
  }
  /// Elements [from, from + count). Both must lie inside.
  constexpr Span sub(std::size_t from, std::size_t count) const {
    assert(from <= size_ && count <= size_ - from);
    return {data_ + from, count};
  }
  constexpr Span from(std::size_t first) const { return sub(first, size_ - first); }
  constexpr Span first(std::size_t count) const { return sub(0, count); }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace coupler
