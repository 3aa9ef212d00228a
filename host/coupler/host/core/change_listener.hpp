// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "coupler/base/line_limit.hpp"
#include "coupler/host/core/clock_mapping.hpp"
#include "coupler/host/core/device_statistics.hpp"
#include "coupler/host/core/paced_transport.hpp"
#include "coupler/host/core/sink.hpp"

namespace coupler::host {

/// Gets what a node tells, in order.
class ChangeSink {
 public:
  virtual ~ChangeSink() = default;
  /// A bit has changed. Changes have numbers, each greater than the one before.
  virtual void on_change(const modbus::Change& change, std::uint64_t number, Stamp stamp) = 0;
  /// What is known of the bits is not true any more: changes were lost, or the node counts them anew.
  virtual void on_gap() = 0;
  /// The node counts its changes anew: what it knew of this connection before is gone. on_gap() follows.
  virtual void on_new_epoch() {}
  /// An answer has come, and all its changes were told. There are no others up to number `newest` but those
  /// that follow; what is read behind this request is newer than all of these. `stamp`: as of the answer;
  /// nullopt if more changes follow.
  virtual void on_heard(std::uint64_t newest, std::optional<Stamp> stamp) = 0;
  /// The node does not tell changes after all.
  virtual void on_end() = 0;
  /// When an answer is wanted although nothing has changed.
  virtual Time answer_wanted() = 0;
};

/// Asks a node for changes, again and again: it answers as soon as there are some, or when the wait is over.
/// A node that stays silent for the wait and a timeout has gone. One that answers at once without end, each
/// time with another epoch, with losses or with nothing, is asked after a pause.
class ChangeListener : private WaitListener {
 public:
  /// Everything given by reference must outlive it. `timeout`: Connection::timeout.
  ChangeListener(std::chrono::milliseconds timeout, PacedTransport& transport, Clock& clock,
                 DeviceStatistics& statistics, ChangeSink& changes, Sink& sink);

  /// A new connection to a node that tells changes; its watchdog expires after `watchdog` without a request
  /// (0: it has none).
  void start(std::chrono::milliseconds watchdog);
  void stop() { active_ = waiting_ = false; }

  /// The node counts its changes anew, so it may have another watchdog than start() was told: ask it, and say
  /// so by set_watchdog(). Until then no wait is long.
  bool asks_for_watchdog() const { return active_ && asks_for_watchdog_; }
  void set_watchdog(std::chrono::milliseconds watchdog);

  bool is_active() const { return active_; }
  bool is_waiting() const { return waiting_; }
  /// A read may be made: it will be known which changes are older.
  bool lets_read() const { return !active_ || waiting_; }
  /// The node has answered since start().
  bool has_heard() const { return epoch_.has_value(); }
  /// In which changes are numbered; nullopt until the first answer.
  std::optional<std::uint32_t> epoch() const { return active_ ? epoch_ : std::nullopt; }
  /// The node's clock.
  const ClockMapping& mapping() const { return mapping_; }
  /// When step() has something to do; the past if it has now.
  Time due() const {
    if (!active_) return Time::max();
    if (asks_for_watchdog_) return Time::min();
    return waiting_ ? look_at_ : resume_at_;
  }
  /// Asks if no answer is outstanding. An error means that the connection can no longer be used.
  Result<> step();
  /// Bytes have come while an answer is outstanding.
  Result<> receive();
  /// Logs what was held back because there was too much of it. To be called now and then, from any thread.
  void report_held_back();

 private:
  void on_wait_answer(const WaitAnswer& answer) override;
  void take(const modbus::ChangesReply& reply, const WaitAnswer& answer);
  void begin_epoch(const modbus::ChangesReply& reply);
  void tell_changes(const modbus::ChangesReply& reply, const WaitAnswer& answer);
  void map_clock(const modbus::ChangesReply& reply, const WaitAnswer& answer);
  Stamp stamp(modbus::NodeTime at, const WaitAnswer& answer) const;
  std::uint16_t wait();
  void pause(Duration at_most);
  void say(LineLimit& lines, Level level, const std::string& text);

  std::chrono::milliseconds timeout_;
  PacedTransport& transport_;
  Clock& clock_;
  DeviceStatistics& statistics_;
  ChangeSink& changes_;
  Sink& sink_;
  ClockMapping mapping_;
  LineLimit jumps_;
  LineLimit epochs_;
  std::chrono::milliseconds longest_wait_{0};
  bool active_ = false;
  bool waiting_ = false;
  bool asks_for_watchdog_ = false;
  bool alone_ = false;                  ///< the answer that comes was not called for by another request
  Time silent_from_{};                  ///< an answer would have come
  Time look_at_{};                      ///< before something sent meanwhile can be late
  Time resume_at_{};                    ///< no request before
  Duration pause_{0};                   ///< after the last gap
  std::optional<Time> gap_at_;          ///< changes were lost, or an epoch began
  Time all_told_{};                     ///< an answer to a request sent then had all there was
  std::optional<std::uint32_t> epoch_;  ///< nullopt until the first answer
  std::uint64_t seen_ = 0;              ///< number of the last change
};

}  // namespace coupler::host
