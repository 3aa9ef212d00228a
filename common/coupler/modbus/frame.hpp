// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "coupler/base/span.hpp"
#include "coupler/modbus/limits.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler::modbus {

/// One Modbus/TCP ADU (TCP 3.1): the MBAP header's fields and the PDU, which has 1 … 253 bytes.
struct Frame {
  std::uint16_t transaction = 0;
  std::uint8_t unit = 0;
  Bytes pdu;
};

/// Writes the MBAP header of a PDU of `pdu_size` bytes: the first mbap_size bytes of an ADU.
void put_header(const Frame& to, std::size_t pdu_size, std::uint8_t* adu);

/// Cuts a TCP stream into frames. The MBAP length alone decides where a frame ends; bytes that follow belong
/// to the next one. Fill room(), say how much with filled(), then take what next() finds until it finds
/// nothing.
class Framer {
 public:
  enum class Outcome {
    nothing,  ///< more bytes are needed
    frame,    ///< frame() holds the next one
    bad,  ///< protocol id not 0 or length outside 2 … 254: the stream cannot be trusted any more, close it
  };

  /// The place for the next bytes. It is never empty after next() found nothing, because the buffer holds the
  /// longest ADU. The call invalidates frame().
  Span<std::uint8_t> room();
  void filled(std::size_t bytes);

  Outcome next();
  /// The frame that next() found; its PDU is valid until next() or room() is called.
  const Frame& frame() const { return frame_; }

  /// Part of a frame is there and waits for the rest.
  bool is_partial() const { return begin_ != end_; }

  /// The bytes that were filled in and are not part of a frame that next() has found.
  Bytes rest() const { return Bytes(buffer_.data() + begin_, end_ - begin_); }

  void reset() { begin_ = end_ = 0; }

 private:
  std::array<std::uint8_t, max_adu_size> buffer_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  Frame frame_;
};

}  // namespace coupler::modbus
