// SPDX-License-Identifier: Apache-2.0
// RTU frames: unit, PDU, CRC ("MODBUS over Serial Line Specification and Implementation Guide V1.02",
// MSL, 2.5.1).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "coupler/base/span.hpp"
#include "coupler/modbus/limits.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler::modbus {

constexpr std::size_t rtu_overhead = 3;                            ///< unit and CRC
constexpr std::size_t max_rtu_size = max_pdu_size + rtu_overhead;  ///< MSL 2.5.1.1

/// MSL 6.2.2. In a frame its low byte comes first; over a whole frame, with these two bytes, it is 0.
std::uint16_t crc16(Bytes bytes);

/// Writes the frame of a PDU of 1 … max_pdu_size bytes into `frame`, which has room for max_rtu_size. Returns
/// its size.
std::size_t put_rtu_frame(std::uint8_t unit, Bytes pdu, std::uint8_t* frame);

/// How many bytes the PDU of a reply to `request` has, as far as the beginning of it says; 0: that is too
/// little to know. nullopt: of such a function that is not known here.
std::optional<std::size_t> reply_size(Bytes request, Bytes beginning);

/// The size of the PDU that answers `request` and is no exception. nullopt: its function says nothing of
/// that.
std::optional<std::size_t> answer_size(Bytes request);

/// The size of the longest PDU that can answer `request`.
inline std::size_t longest_reply(Bytes request) { return answer_size(request).value_or(max_pdu_size); }

/// Finds the reply to a request in what comes over a serial line: by unit, function code, length and CRC; a
/// confirmation by what it repeats.
/// Silence decides nothing, since USB adapters deliver in bursts. What is not the reply is skipped: noise,
/// the late reply of another unit, the echo of the request.
///
/// Fill room(), say how much with filled(), then look with next().
class RtuFramer {
 public:
  enum class Outcome {
    nothing,  ///< more bytes are needed
    reply,    ///< pdu() is the reply
    damaged,  ///< something has come that is neither the reply nor its beginning; the reply may still follow
  };

  /// A request is about to be sent: 1 … 247 as `unit`. Forgets what has come.
  void expect(std::uint8_t unit, Bytes pdu);
  /// The whole frame of the request.
  Bytes request() const { return Bytes(request_).first(request_size_); }
  Bytes request_pdu() const { return request().sub(1, request_size_ - rtu_overhead); }

  /// The place for the next bytes. It is never empty. The call invalidates pdu().
  Span<std::uint8_t> room();
  void filled(std::size_t bytes);

  Outcome next();
  Bytes pdu() const { return pdu_; }

  /// How many bytes have come since the request that are neither its echo nor its reply.
  std::size_t skipped() const;
  /// All that has come is one whole frame, of another unit for instance.
  bool holds_another_frame() const;

  /// Returns whether the line hands back what is sent, as some adapters for RS-485 do; nullopt if that is not
  /// known yet.
  std::optional<bool> has_echo() const { return has_echo_; }
  /// The echo of this request could be taken for its reply (function codes 5, 6, 8, 22): a read shows first
  /// whether the line has one.
  bool needs_a_read_before(Bytes pdu) const { return !has_echo_ && is_its_own_reply(pdu); }
  /// Nothing has come for so long that an echo would have.
  void silent();
  /// The line is another one.
  void reset() { has_echo_.reset(); }

 private:
  enum class Found { none, beginning, reply };

  static bool is_its_own_reply(Bytes pdu) { return reply_size(pdu, pdu) == pdu.size(); }
  void skip_echo();
  bool echo_may_come() const;
  bool can_answer(Bytes pdu) const;
  Found look_at(std::size_t begin);

  std::array<std::uint8_t, max_rtu_size> request_{};
  std::size_t request_size_ = 0;
  std::array<std::uint8_t, 3 * max_rtu_size> buffer_{};  ///< an echo, a reply that is late, the reply
  std::size_t begin_ = 0;                                ///< of what is not the echo
  std::size_t end_ = 0;
  std::size_t come_ = 0;   ///< bytes since the request
  bool had_echo_ = false;  ///< of this request
  std::optional<bool> has_echo_;
  Bytes pdu_;
};

}  // namespace coupler::modbus
