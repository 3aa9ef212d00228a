// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "coupler/base/log_line_limit.hpp"
#include "coupler/host/core/clock_mapping.hpp"
#include "coupler/host/core/device_statistics.hpp"
#include "coupler/host/core/link.hpp"
#include "coupler/host/core/sink.hpp"

namespace coupler::host {

/// Receives what a node tells, in order.
class ChangeSink {
 public:
  virtual ~ChangeSink() = default;
  /// A bit has changed. The number of a change is greater than that of the one before.
  virtual void on_change(const modbus::Change& change, std::uint64_t number, Stamp stamp) = 0;
  /// The known values of the bits may be wrong, because changes were lost or the node began a new epoch.
  virtual void on_gap() = 0;
  /// The node began a new epoch: it has forgotten what it knew of this connection. on_gap() follows.
  virtual void on_new_epoch() {}
  /// All changes of an answer were passed on. Up to number `newest` there are no others except those that
  /// follow, and what is read after this request is newer than all of them. `stamp` is the time of the
  /// answer; nullopt if more changes follow.
  virtual void on_heard(std::uint64_t newest, std::optional<Stamp> stamp) = 0;
  /// The node does not tell changes after all.
  virtual void on_end() = 0;
  /// The time at which an answer is wanted even if nothing has changed.
  virtual Time answer_wanted() = 0;
};

/// Asks a node for changes again and again. The node answers as soon as there are changes, or at the end of
/// the wait. A node that is silent for the wait and a timeout is gone. A node that always answers at once
/// with another epoch, with losses or with nothing is asked after a pause.
class ChangeListener : private WaitListener {
 public:
  /// All references must outlive the listener. `timeout`: see Connection::timeout.
  ChangeListener(std::chrono::milliseconds timeout, Link& link, DeviceStatistics& statistics,
                 ChangeSink& changes, Sink& sink);

  /// Starts with a new connection to a node that tells changes. The node's watchdog expires after `watchdog`
  /// without a request; 0: it has none.
  void start(std::chrono::milliseconds watchdog);
  void stop() { active_ = waiting_ = false; }

  /// Returns whether the node began a new epoch, so that it may have another watchdog than start() was told.
  /// Ask the node, and call set_watchdog(). Until then waits are short.
  bool asks_for_watchdog() const { return active_ && asks_for_watchdog_; }
  void set_watchdog(std::chrono::milliseconds watchdog);

  bool is_active() const { return active_; }
  bool is_waiting() const { return waiting_; }
  /// Returns whether a read may be sent, because it will be known which changes are older.
  bool lets_read() const { return !active_ || waiting_; }
  /// Returns whether the node has answered since start().
  bool has_heard() const { return epoch_.has_value(); }
  /// The epoch in which changes are numbered; nullopt until the first answer.
  std::optional<std::uint32_t> epoch() const { return active_ ? epoch_ : std::nullopt; }
  /// The mapping of the node's clock.
  const ClockMapping& mapping() const { return mapping_; }
  /// The time at which step() has something to do; it is in the past if that is now.
  Time due() const {
    if (!active_) return Time::max();
    if (asks_for_watchdog_) return Time::min();
    return waiting_ ? look_at_ : resume_at_;
  }
  /// Sends a wait if none is outstanding. An error means that the connection can no longer be used.
  Result<> step();
  /// Receives the answer, after bytes have come while one is outstanding.
  Result<> receive();
  /// Logs the lines that were held back because there were too many. Call it now and then, from any thread.
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
  void say(LogLineLimit& lines, Level level, const std::string& text);

  std::chrono::milliseconds timeout_;
  Link& link_;
  Clock& clock_;
  DeviceStatistics& statistics_;
  ChangeSink& changes_;
  Sink& sink_;
  ClockMapping mapping_;
  LogLineLimit jumps_;
  LogLineLimit epochs_;
  std::chrono::milliseconds longest_wait_{0};
  bool active_ = false;
  bool waiting_ = false;
  bool asks_for_watchdog_ = false;
  bool alone_ = false;                  ///< no other request makes the node send the next answer
  Time silent_from_{};                  ///< from this time on the node is silent
  Time look_at_{};                      ///< the time before which nothing that was sent meanwhile can be late
  Time resume_at_{};                    ///< no request is sent before
  Duration pause_{0};                   ///< the pause after the last gap
  std::optional<Time> gap_at_;          ///< the time at which changes were lost or an epoch began
  Time all_told_{};                     ///< the time of the last request whose answer had all changes
  std::optional<std::uint32_t> epoch_;  ///< nullopt until the first answer
  std::uint64_t seen_ = 0;              ///< the number of the last change
};

}  // namespace coupler::host
