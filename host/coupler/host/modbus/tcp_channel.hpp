// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "coupler/host/core/channel.hpp"
#include "coupler/host/modbus/tcp_framer.hpp"
#include "coupler/host/modbus/tls_socket.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// A connection by Modbus/TCP, with or without TLS, to a device or a gateway. docs/decisions/0001 says why
/// libmodbus does not do this.
class TcpChannel : public Channel {
 public:
  /// `transaction_ids`: the device repeats the transaction id of a request in its reply.
  explicit TcpChannel(const Connection& connection, bool transaction_ids = true);
  ~TcpChannel() override;
  TcpChannel(const TcpChannel&) = delete;
  TcpChannel& operator=(const TcpChannel&) = delete;

  Result<> open(const Event& interrupt) override;
  void close() override;
  void hang_up() override;
  Result<> select(std::uint8_t unit, std::chrono::milliseconds timeout) override;
  Result<> send(modbus::Bytes pdu) override;
  Result<modbus::Bytes> receive() override;
  bool is_late() const override { return answer_by_.has_passed(); }
  bool is_trusted() const override { return wait_ || framer_.is_trusted(); }
  /// The answer to a wait and the reply to another request are told apart by their transactions.
  bool can_wait() const override { return transaction_ids_; }
  Result<> send_wait(const modbus::ChangesRequest& request) override;
  Result<> receive_wait() override;
  std::optional<Certificates> certificates() const override;
  std::optional<WaitAnswer> take_wait_answer() override { return std::exchange(wait_answer_, std::nullopt); }
  Result<> discard_unasked() override;
  std::uint64_t discarded() const override { return framer_.skipped(); }
  Woken wait_until(Time time, Wakeup& wakeup, const Event& interrupted) override;

 private:
  /// Looks whether the connection can take a request.
  Result<> make_ready();
  /// Builds a request to the selected unit with the next transaction number.
  void build(TcpRequest& request, modbus::Bytes pdu);
  Result<> put(const TcpRequest& request);
  /// Behaves as recv(2).
  ssize_t take(Span<std::uint8_t> room);
  bool has_pending() const { return tls_socket_ && tls_socket_->has_pending(); }
  /// Waits for the reply. Its PDU is valid until the next call. If `has_come`, a part of it has come, and the
  /// rest must follow within a timeout from now.
  Result<modbus::Bytes> await_reply(const TcpRequest& request, Deadline deadline, bool has_come = false);
  /// Returns a BadFrame instead of `error` if noise has come.
  tl::unexpected<Error> no_reply(const TcpRequest& request, Error error) const;
  /// Receives the answer to an outstanding wait, which comes before the reply to the request that was just
  /// sent.
  Result<> receive_wait_before(const Deadline& deadline);
  Result<> take_wait_reply(const Result<modbus::Bytes>& pdu);

  /// An outstanding wait for changes.
  struct Wait {
    TcpRequest request;
    Time sent{};
    Deadline answer_by;
  };

  /// Returns the reason that the TLS connection gives for its end, or else `error`.
  tl::unexpected<Error> failed(Error error) const;

  std::string host_;
  std::uint16_t port_;
  std::uint8_t unit_;
  std::optional<TlsTexts> tls_;  ///< nullopt: plain Modbus/TCP
  std::chrono::milliseconds timeout_{0};
  bool transaction_ids_;
  std::uint16_t transaction_;  ///< of the last request
  TcpRequest sent_;            ///< its answer is awaited
  Deadline answer_by_{std::chrono::milliseconds(0)};
  TcpFramer framer_;
  std::optional<Wait> wait_;
  std::optional<WaitAnswer> wait_answer_;  ///< until it is taken
  /// Guards socket_ and certificates_, which other threads use in hang_up() and certificates(). Never held
  /// during a request.
  mutable std::mutex socket_mutex_;
  Descriptor socket_;
  std::optional<Certificates> certificates_;
  std::unique_ptr<TlsSocket> tls_socket_;  ///< over socket_, which it must not outlive; null without TLS
};

}  // namespace coupler::host
