// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "coupler/base/span.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler::modbus {

/// Received bytes of a stream, until a framer takes them.
template <std::size_t Size>
class ReceiveBuffer {
 public:
  /// The place for the next bytes; empty if the buffer is full. The call invalidates all views of taken
  /// bytes.
  Span<std::uint8_t> room() {
    if (begin_ != 0) {
      std::memmove(bytes_.data(), bytes_.data() + begin_, end_ - begin_);
      end_ -= begin_;
      begin_ = 0;
    }
    return Span<std::uint8_t>(bytes_).from(end_);
  }
  void filled(std::size_t bytes) {
    assert(bytes <= bytes_.size() - end_);
    end_ += bytes;
  }

  Bytes bytes() const { return {bytes_.data() + begin_, end_ - begin_}; }
  /// Takes the first bytes. A view of them is valid until room() is called.
  void take(std::size_t bytes) {
    assert(bytes <= end_ - begin_);
    begin_ += bytes;
  }
  void clear() { begin_ = end_ = 0; }

 private:
  std::array<std::uint8_t, Size> bytes_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
};

}  // namespace coupler::modbus
