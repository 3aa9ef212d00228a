// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "coupler/base/span.hpp"
#include "coupler/host/core/error.hpp"
#include "coupler/modbus/limits.hpp"
#include "coupler/modbus/pdu.hpp"
#include "coupler/modbus/receive_buffer.hpp"

namespace coupler::host {

/// The ADU of a request over Modbus/TCP: the MBAP header and the PDU (TCP 3.1).
class TcpRequest {
 public:
  /// `pdu` has 1 … 253 bytes. Without a transaction, which is 0 then, the reply may have any: it is
  /// recognized by its unit, function code and length.
  void set(std::optional<std::uint16_t> transaction, std::uint8_t unit, modbus::Bytes pdu);

  modbus::Bytes adu() const { return modbus::Bytes(adu_).first(size_); }
  modbus::Bytes pdu() const { return adu().from(modbus::mbap_size); }
  bool has_transaction() const { return has_transaction_; }
  std::uint16_t transaction() const { return modbus::get_u16(adu_.data()); }
  std::uint8_t unit() const { return adu_[modbus::mbap_size - 1]; }
  std::uint8_t function() const { return adu_[modbus::mbap_size]; }

 private:
  std::array<std::uint8_t, modbus::max_adu_size> adu_{};
  std::size_t size_ = 0;
  bool has_transaction_ = true;
};

/// Finds replies in what comes over one Modbus/TCP connection, by transaction, unit and length.
///
/// Before the first reply, and once a connection has brought bytes that nobody asked for, the framer skips
/// what cannot begin the reply: the greeting of a serial server, a heartbeat, a frame for another client.
/// Otherwise the reply must begin with the first byte, or behind late replies to requests that were given up.
///
/// Write received bytes into room(), call filled() with their number, then next(). The framer needs no
/// socket.
class TcpFramer {
 public:
  enum class Outcome {
    nothing,  ///< more bytes are needed
    reply,    ///< pdu() is the reply
    bad,      ///< problem() says why this is no reply to the request
  };

  /// Begins with a new connection.
  void reset();

  /// The place for the next bytes. It is never empty after Outcome::nothing. The call invalidates pdu().
  Span<std::uint8_t> room() { return buffer_.room(); }
  void filled(std::size_t bytes) { buffer_.filled(bytes); }

  Outcome next(const TcpRequest& request);
  /// The PDU of the reply. That of an exception has two bytes at most.
  modbus::Bytes pdu() const { return pdu_; }
  /// A BadFrame, or NotConnected if the device speaks TLS.
  const Error& problem() const { return problem_; }

  /// Returns false after an exception whose length is not that in its header, because it is not known then
  /// where the next reply begins. Returns false after a request without a transaction that had no good reply,
  /// or may have another one, because that would be taken for the next reply. The connection must be closed.
  bool is_trusted() const { return is_trusted_; }

  /// Notes that the reply is not awaited any more. If it comes before another one it is skipped.
  void give_up(const TcpRequest& request) {
    ++given_up_;
    if (!request.has_transaction()) is_trusted_ = false;
  }
  bool is_empty() const { return rest().empty(); }
  /// Returns whether no reply has come over this connection.
  bool is_first() const { return is_first_; }

  /// Skips all bytes that have come, because no request is outstanding, and starts a new noise().
  void drop();
  /// The number of bytes that next() and drop() have skipped over all connections. Any thread may call it.
  std::uint64_t skipped() const { return skipped_; }
  /// Returns an error if bytes were skipped since the last drop(), and those behind them do not begin the
  /// reply.
  std::optional<BadFrame> noise(const TcpRequest& request) const;

 private:
  modbus::Bytes rest() const { return buffer_.bytes(); }
  void skip(std::size_t bytes);
  /// Skips late replies. Returns false if one of them has not come as a whole.
  bool skip_late_replies(const TcpRequest& request);
  Outcome take(const TcpRequest& request, std::size_t bytes);
  Outcome refuse(const TcpRequest& request, Error problem);

  modbus::ReceiveBuffer<2 * modbus::max_adu_size> buffer_;  ///< a wait and a read may be answered at once
  modbus::Bytes pdu_;
  Error problem_;
  bool is_first_ = true;    ///< no reply has come over this connection
  bool has_noise_ = false;  ///< bytes were skipped over this connection
  bool is_trusted_ = true;
  std::uint16_t given_up_ = 0;  ///< requests since the last reply
  std::atomic<std::uint64_t> skipped_{0};
  std::uint64_t skipped_before_ = 0;             ///< of these, before the last drop()
  std::array<std::uint8_t, 9> first_skipped_{};  ///< since then, to be shown
};

}  // namespace coupler::host
