// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "coupler/host/core/transport.hpp"
#include "coupler/host/core/write.hpp"

namespace coupler::host {

/// What a point holds after a write, compared with what was written.
class ReadBack {
 public:
  /// Reads the point where it reads back.
  Result<> read(const Write& write, const Map& map, Transport& transport);

  /// Only the point's own bits count.
  bool is_equal() const;
  /// As Point::initial; valid as long as this.
  Span<const std::uint16_t> written() const { return {written_.data(), count_}; }
  Span<const std::uint16_t> found() const { return {found_.data(), count_}; }

 private:
  std::array<std::uint16_t, modbus::max_read_bits> written_{};
  std::array<std::uint16_t, modbus::max_read_bits> found_{};
  std::size_t count_ = 0;
};

}  // namespace coupler::host
