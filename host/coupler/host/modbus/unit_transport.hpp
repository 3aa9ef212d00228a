// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <memory>

#include "coupler/host/modbus/multi_unit_transport.hpp"
#include "coupler/host/modbus/turns.hpp"
#include "coupler/host/modbus/wait.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// One connection to a gateway, or to a serial line. What is not atomic is for the unit that has the turn.
struct SharedConnection {
  explicit SharedConnection(const Connection& gateway) : transport(make_transport(gateway)) {}

  Turns turns;
  std::unique_ptr<MultiUnitTransport> transport;
  bool open = false;
  std::atomic<int> users{0};            ///< units that are connected
  std::atomic<std::uint64_t> ended{0};  ///< how often the gateway has ended it, or could not be reached
  Time opened{};
  Time answered{};  ///< the last request
};

/// One of several units behind a gateway that share a connection, request by request: writes first, also
/// those of a unit whose own read waits for its turn.
///
/// If a unit stays silent its answer may still come. On a bus it is not asked for a timeout, while the others
/// are; otherwise the connection is closed, and the others open it again and notice nothing. If the gateway
/// ends the connection, or the serial port goes, it is lost for all units: the devices behind it may have
/// changed.
class UnitTransport : public Transport {
 public:
  UnitTransport(std::shared_ptr<SharedConnection> shared, const Connection& unit, const Limits& limits);
  ~UnitTransport() override { UnitTransport::close(); }
  UnitTransport(const UnitTransport&) = delete;
  UnitTransport& operator=(const UnitTransport&) = delete;

  Result<> connect() override;
  void close() override;
  void interrupt() override;
  Result<modbus::Bytes> exchange(modbus::Bytes pdu) override;
  Result<> send_pdu(modbus::Bytes pdu) override;
  Result<modbus::Bytes> receive_pdu() override;
  void rank(Rank rank) override;
  Turn await_turn(Time until, bool write_waits = false) override;
  void await_turn_to_write(const std::function<bool()>& ends) override;
  bool reserve() override;
  void give_back() override;
  std::uint64_t discarded() const override { return shared_->transport->discarded(); }
  std::optional<Certificates> certificates() const override { return shared_->transport->certificates(); }
  Woken wait_until(Time time) override { return wait_for(wakeup_, interrupted_, -1, time); }
  void wake() override;

 private:
  Result<> take(Rank rank);
  void release();
  bool is_lost() const { return connected_ && ended_ != shared_->ended; }
  /// take() and prepare().
  Result<> begin(Rank rank);
  Result<> prepare();
  void wait_until_past(Time time);
  Result<> open();
  Time ready() const;
  void done(const Error* error);
  Result<modbus::Bytes> done(const Result<modbus::Bytes>& reply);
  void unanswered();

  std::shared_ptr<SharedConnection> shared_;
  std::uint8_t unit_;
  std::chrono::milliseconds timeout_;
  Duration gap_;
  Duration delay_;
  Event interrupted_;
  Wakeup wakeup_;
  std::atomic<bool> woken_{false};  ///< since await_turn() returned because of it
  Rank rank_ = Rank::read;
  bool connected_ = false;
  Time late_until_{};        ///< its answer to a request that has ended may still come
  std::uint64_t ended_ = 0;  ///< SharedConnection::ended when it connected
  bool has_turn_ = false;    ///< for the request that follows
  bool reserved_ = false;    ///< by reserve()
  bool in_flight_ = false;   ///< it has the turn until receive_pdu()
  std::array<std::uint8_t, modbus::max_pdu_size> reply_{};  ///< a copy, since another unit's reply comes next
};

}  // namespace coupler::host
