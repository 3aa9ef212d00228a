// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <cstdint>
#include <optional>

namespace coupler::modbus {

/// One or more consecutive addresses of a table. It cannot be empty or run past address 65535.
class Range {
 public:
  /// nullopt if count is 0 or the last address would be above 65535.
  static constexpr std::optional<Range> make(std::uint32_t start, std::uint32_t count) {
    if (count == 0 || start > 0xFFFF || count > 0x10000 - start) return std::nullopt;
    return Range(start, count);
  }
  /// Makes a range from values that are known to be valid.
  static constexpr Range of(std::uint32_t start, std::uint32_t count) {
    assert(make(start, count).has_value());
    return {start, count};
  }

  constexpr std::uint16_t start() const { return static_cast<std::uint16_t>(start_); }
  constexpr std::uint32_t count() const { return end_ - start_; }
  /// One past the last address: 1 … 65536.
  constexpr std::uint32_t end() const { return end_; }
  constexpr std::uint16_t last() const { return static_cast<std::uint16_t>(end_ - 1); }

  constexpr bool contains(std::uint32_t address) const { return address >= start_ && address < end_; }
  constexpr bool contains(Range other) const { return other.start_ >= start_ && other.end_ <= end_; }
  constexpr bool overlaps(Range other) const { return other.start_ < end_ && start_ < other.end_; }

  friend constexpr bool operator==(Range a, Range b) { return a.start_ == b.start_ && a.end_ == b.end_; }
  friend constexpr bool operator!=(Range a, Range b) { return !(a == b); }

 private:
  constexpr Range(std::uint32_t start, std::uint32_t count) : start_(start), end_(start + count) {}
  std::uint32_t start_;
  std::uint32_t end_;
};

/// Calls `use` with each address that both have, in ascending order.
template <class Use>
constexpr void each_shared_address(Range a, Range b, Use use) {
  const std::uint32_t end = a.end() < b.end() ? a.end() : b.end();
  for (std::uint32_t at = a.start() < b.start() ? b.start() : a.start(); at < end; ++at) use(at);
}

}  // namespace coupler::modbus
