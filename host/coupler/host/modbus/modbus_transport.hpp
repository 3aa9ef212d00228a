// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "coupler/host/modbus/multi_unit_transport.hpp"
#include "coupler/host/modbus/tls_link.hpp"
#include "coupler/modbus/frame.hpp"

struct _modbus;  // NOLINT(bugprone-reserved-identifier): libmodbus's name for its context

namespace coupler::host {

/// A Modbus/TCP device, or a gateway. libmodbus holds the connection and receives the replies to reads.
/// Everything else is our own: libmodbus does not compare unit ids, does not report exception codes above 0B,
/// cannot send a write in one thread and receive the answer in another, and its connect can neither be
/// interrupted nor resolve names in the background.
class ModbusTransport : public MultiUnitTransport {
 public:
  explicit ModbusTransport(const Connection& connection);
  ~ModbusTransport() override;
  ModbusTransport(const ModbusTransport&) = delete;
  ModbusTransport& operator=(const ModbusTransport&) = delete;

  Result<> connect() override;
  void close() override;
  void interrupt() override;
  Result<modbus::ScheduleReply> schedule(const modbus::ScheduleRequest& request) override;
  bool can_wait() const override { return true; }
  Result<> send_wait(const modbus::ChangesRequest& request) override;
  Result<> receive_wait() override;
  std::optional<Certificates> certificates() const override;
  std::optional<WaitAnswer> take_wait_answer() override { return std::exchange(wait_answer_, std::nullopt); }
  Result<> discard_unasked() override;
  std::uint64_t discarded() const override { return discarded_; }
  Woken wait_until(Time time) override;
  void wake() override { wakeup_.call(); }

  Result<> select(std::uint8_t unit, std::chrono::milliseconds timeout) override;
  Result<> open(const Event& interrupt) override;
  void hang_up() override;

 protected:
  Result<modbus::Bytes> ask(const modbus::ReadRequest& request) override;
  Result<> send_pdu(modbus::Bytes pdu) override;
  Result<modbus::Bytes> receive_pdu() override;

 private:
  /// To be called before a request is sent.
  Result<> make_ready();
  void throw_away(std::uint64_t bytes);
  /// Of an exception whose header lies about its length: what follows cannot be trusted.
  modbus::Bytes take_lying_exception(const modbus::Framer& framer, const Result<modbus::Bytes>& reply);
  modbus::Frame next_header();
  /// The answer to a wait comes before that to the request which has been sent now.
  Result<> receive_wait_before(const Deadline& deadline);
  Result<> take_wait_reply(const Result<modbus::Bytes>& pdu);

  /// A wait for changes that is outstanding.
  struct Wait {
    modbus::Frame header;
    Time sent{};
    Deadline answer_by;
  };

  /// Says why a connection with TLS has ended.
  tl::unexpected<Error> failed(Error error) const;

  std::string host_;
  std::uint16_t port_;
  std::uint8_t unit_;
  std::optional<TlsTexts> tls_;    ///< nullopt: plain Modbus/TCP
  std::unique_ptr<TlsLink> link_;  ///< of a connection with TLS
  std::chrono::milliseconds timeout_{0};
  std::unique_ptr<_modbus, void (*)(_modbus*)> context_;
  Event interrupted_;
  Wakeup wakeup_;
  modbus::Frame sent_;  ///< the header of the request whose answer is awaited
  std::array<std::uint8_t, modbus::max_adu_size> reply_{};
  Deadline answer_by_{std::chrono::milliseconds(0)};
  std::uint8_t function_ = 0;  ///< of that request
  bool is_first_ = true;       ///< nothing has been answered over this connection
  std::uint64_t unasked_ = 0;  ///< bytes thrown away over this connection
  bool is_untrusted_ = false;  ///< the connection is made anew before the next request
  std::atomic<std::uint64_t> discarded_{0};
  std::optional<Wait> wait_;
  std::optional<WaitAnswer> wait_answer_;  ///< until it is taken
  /// Between the owner and other threads, of what follows; never held during a request.
  mutable std::mutex socket_mutex_;
  int socket_ = -1;
  std::optional<Certificates> certificates_;
};

}  // namespace coupler::host
