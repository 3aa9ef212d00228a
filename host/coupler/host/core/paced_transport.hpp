// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <bitset>
#include <functional>

#include "coupler/host/core/clock.hpp"
#include "coupler/host/core/device_statistics.hpp"
#include "coupler/host/core/stamp.hpp"
#include "coupler/host/core/transport.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// Receives the answers to waits for changes.
class WaitListener {
 public:
  virtual ~WaitListener() = default;
  /// Called before the reply to a request that was sent after the wait is used: that reply is newer.
  virtual void on_wait_answer(const WaitAnswer& answer) = 0;
};

/// Makes the pauses that some devices need: `connect_delay` after a connect, `request_gap` between a reply
/// and the next request. Measures the time of each request.
class PacedTransport : public Transport {
 public:
  PacedTransport(Transport& transport, Clock& clock, const Limits& limits, DeviceStatistics& statistics)
      : transport_(transport),
        clock_(clock),
        statistics_(statistics),
        gap_(limits.request_gap),
        delay_(limits.connect_delay) {}

  Clock& clock() const { return clock_; }
  Result<> connect() override;
  void close() override { transport_.close(); }
  void interrupt() override { transport_.interrupt(); }
  Result<modbus::Bytes> exchange(modbus::Bytes pdu) override;
  Result<> send_pdu(modbus::Bytes pdu) override;
  Result<modbus::Bytes> receive_pdu() override;
  void rank(Rank rank) override { transport_.rank(rank); }
  Turn await_turn(Time until, bool write_waits = false) override {
    pause();  // before the turn, which others wait for
    return transport_.await_turn(until, write_waits);
  }
  void await_turn_to_write(const std::function<bool()>& ends) override {
    pause();
    transport_.await_turn_to_write(ends);
  }
  bool reserve() override { return transport_.reserve(); }
  void give_back() override { transport_.give_back(); }
  bool can_wait() const override { return transport_.can_wait(); }
  Result<> send_wait(const modbus::ChangesRequest& request) override;
  Result<> receive_wait() override;
  /// Sets the receiver of the answers; take_wait_answer() returns none.
  void listen(WaitListener& listener) { listener_ = &listener; }
  Woken wait_until(Time time) override { return transport_.wait_until(time); }
  Result<> discard_unasked() override { return transport_.discard_unasked(); }
  std::uint64_t discarded() const override { return transport_.discarded(); }
  std::optional<Certificates> certificates() const override { return transport_.certificates(); }
  void wake() override { transport_.wake(); }

  /// Reads, only to see whether the device answers. An exception is an answer, unless it says that the unit
  /// is away.
  Result<> ask(const Unreadable& place);
  /// Does the same with the first readable point, or else with coil 0.
  Result<> keep_alive(const Map& map);

  /// Returns whether a request needs no pause now.
  bool is_ready() const { return clock_.now() >= ready_; }
  /// The time of the reply to the last request, or of its failure.
  Time last_answer() const { return answered_; }
  /// The stamp of the values in the last reply to a read, between the times of request and reply.
  Stamp last_stamp() const { return stamp_between(begun_, answered_); }
  /// The stamp of the last confirmed write, which was carried out between the times of request and reply.
  Stamp last_write() const { return written_; }
  /// The number of requests that were answered, also by an exception.
  std::uint64_t replies() const { return replies_; }
  /// Returns whether the last request over this connection was answered by the unit, and not by a gateway for
  /// a unit that is away. Any thread may call it.
  bool unit_answers() const { return unit_answers_; }

  /// Returns whether a request was answered with this exception since the last forget_exceptions().
  bool has_seen(modbus::Exception code) const { return seen_[static_cast<std::size_t>(code)]; }
  void forget_exceptions() { seen_.reset(); }

 private:
  void pause();
  /// The next request is sent no sooner than `rest` after `time`.
  void ended_at(Time time, Duration rest);
  void answered(const Error* error);
  template <class T>
  Result<T> answered(Result<T> result) {
    answered(result ? nullptr : &result.error());
    return result;
  }
  void give(const std::optional<WaitAnswer>& answer);

  Transport& transport_;
  Clock& clock_;
  DeviceStatistics& statistics_;
  WaitListener* listener_ = nullptr;
  Duration gap_;
  Duration delay_;
  Time ready_ = Time::min();  ///< no request is sent before
  Time begun_{};              ///< the time of the request in flight
  Time answered_{};
  Stamp written_{};
  std::uint64_t replies_ = 0;
  std::atomic<bool> unit_answers_{false};
  std::bitset<256> seen_;  ///< the exceptions that came
};

}  // namespace coupler::host
