// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "coupler/base/span.hpp"
#include "coupler/modbus/limits.hpp"
#include "coupler/modbus/pdu.hpp"
#include "coupler/modbus/receive_buffer.hpp"

namespace coupler::modbus {

/// One Modbus/TCP ADU (TCP 3.1): the MBAP header's fields and the PDU, which has 1 … 253 bytes.
struct Frame {
  std::uint16_t transaction = 0;
  std::uint8_t unit = 0;
  Bytes pdu;
};

// The places of the fields of the MBAP header, and of what follows it.
constexpr std::size_t at_protocol = 2;
constexpr std::size_t at_length = 4;
constexpr std::size_t at_unit = 6;

/// Returns the size of an ADU, of which at least the first `at_unit` bytes are there; 0 if its header is none
/// of Modbus/TCP: a protocol that is not 0, or a length outside 2 … 254.
std::size_t adu_size(Bytes adu);

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
  Span<std::uint8_t> room() { return buffer_.room(); }
  void filled(std::size_t bytes) { buffer_.filled(bytes); }

  Outcome next();
  /// The frame that next() found; its PDU is valid until next() or room() is called.
  const Frame& frame() const { return frame_; }

  /// Part of a frame is there and waits for the rest.
  bool is_partial() const { return !rest().empty(); }

  /// The bytes that were filled in and are not part of a frame that next() has found.
  Bytes rest() const { return buffer_.bytes(); }

  void reset() { buffer_.clear(); }

 private:
  ReceiveBuffer<max_adu_size> buffer_;
  Frame frame_;
};

}  // namespace coupler::modbus
