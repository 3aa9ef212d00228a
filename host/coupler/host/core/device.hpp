// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <future>
#include <optional>
#include <string>
#include <utility>

#include "coupler/base/log_line_limit.hpp"
#include "coupler/host/core/backoff.hpp"
#include "coupler/host/core/change_listener.hpp"
#include "coupler/host/core/coupler_watchdog.hpp"
#include "coupler/host/core/device_state.hpp"
#include "coupler/host/core/output_scheduler.hpp"
#include "coupler/host/core/poller.hpp"
#include "coupler/host/core/writer.hpp"

namespace coupler::host {

/// The way in which a program uses a device.
struct Purpose {
  Purpose(Verify if_different, bool looks = false) : verify(if_different), only_looks(looks) {}

  Verify verify;
  /// The program only shows what can be read, whatever the device is. If the device has another map, the
  /// points that are the same in both are read. A device that does not answer the question for its identity
  /// is treated as a foreign coupler. Points that the device rejects are asked for again in each cycle, and
  /// a request that fails is split into smaller ones.
  bool only_looks;
};

/// One coupler: connects and reconnects by itself, verifies that both sides have the same map, writes first
/// and reads on schedule. It has no thread of its own: one calls step() again and again.
///
/// A device whose map differs is left alone under Verify::require: nothing is written, and nothing is read
/// either, since a value from a place that now means something else would be published under the old name.
/// The connection is closed (it may be the only one the device has) and the identity is asked for again after
/// the back-off.
///
/// A unit that its gateway cannot reach is offline, too, and tried again after the back-off. The connection
/// to the gateway stays, since others may use it.
///
/// A node that tells changes of its bits is asked for them all the time, by a request whose answer it holds
/// back. Reads are made while one is outstanding only: its answer says which changes are older than they.
///
/// push(), push_together(), refuse(), report_held_back(), reset_watchdog(), make_safe(), schedule(),
/// cancel_scheduled(), cancel_all(), scheduled(), has_to_end(), answers(), end_comes(), statistics() and
/// revision() may be called from any thread. All other functions are for the thread that owns the connection.
/// Another thread may call send_now() if it has made sure that the owner is only waiting.
class Device {
 public:
  /// `map`'s views, and everything given by reference, must outlive the device.
  Device(const Map& map, Purpose purpose, MapLoader load, Link& link, ValueTable& values, Sink& sink);

  /// Queues a write. Its listener gets the result.
  void push(const Write& write) { writer_.push(write); }
  void push_together(Span<const Write> writes) { writer_.push_together(writes); }
  /// Counts a value that is not valid for its point, and reports it to the listener.
  void refuse(const Write& write, std::string_view why) { writer_.refuse(write, why); }

  /// Drops what is queued. Any thread may call it after stop().
  void drop_all() { writer_.drop_all(); }

  /// See Writer.
  void report_held_back() {
    writer_.report_held_back();
    listener_.report_held_back();
  }

  /// Resets the coupler's own watchdog.
  std::future<CallAnswer> reset_watchdog() { return watchdog_.ask_reset(); }
  /// See Writer::ask_safe().
  std::future<CallAnswer> make_safe() { return writer_.ask_safe(); }
  /// See OutputScheduler::ask().
  std::future<ScheduleAnswer> schedule(const ScheduledWrite& what) { return scheduler_.ask(what); }
  void schedule(const ScheduledWrite& what, Reply<ScheduleAnswer>::Give give) {
    scheduler_.ask(what, std::move(give));
  }
  std::future<CallAnswer> cancel_scheduled(std::uint32_t number) { return scheduler_.cancel(number); }
  /// See OutputScheduler::cancel_all().
  void cancel_all(WritesFrom which, Reply<CallAnswer>::Give give) {
    scheduler_.cancel_all(std::move(which), std::move(give));
  }
  std::vector<WaitingWrite> scheduled() const { return scheduler_.waiting(); }
  /// Returns whether stop() has to send requests because of scheduled outputs.
  bool has_to_end() const { return scheduler_.is_busy(); }
  /// Returns whether the device answered the last request, so that its outputs may have been written and can
  /// be written now.
  bool answers() const { return link_.unit_answers(); }

  /// Sends what is queued, if that is possible without waiting. If it returns false, step() must be called.
  bool send_now() { return is_verified() && !is_read_first(clock_.now()) && writer_.send_now(); }

  /// Makes at most one request that is due. Returns the time of the next one, which is not later than now if
  /// more is due already. A queued write is always due while connected.
  Time step();
  /// Handles bytes that have come while no step() ran: the answer to send_now(), or else the end of the
  /// connection.
  void arrived();
  /// Closes the connection after step() has thrown. Returns when to call step() again, after the back-off.
  Time give_up(const std::string& why) {
    lost(TransportFailure{why});
    return retry_at_;
  }
  /// From now on a lost connection is not logged.
  void end_comes() { ending_ = true; }
  /// Ends: sets outputs as `on_shutdown` says, and closes the connection for good. Returns false if an output
  /// should have its safe value but does not.
  bool stop();

  /// Sets whether somebody wants the values of a point (index into Map::points). See BitChanges.
  void want(std::uint32_t point, bool wanted) { poller_.want(point, wanted); }

  DeviceSnapshot statistics() const { return {statistics_.counts(), link_.counts(), link_.discarded()}; }
  /// A number that changes when ValueTable::revision() or the connection in statistics() changes. It does
  /// not change merely because time passes.
  std::uint64_t revision() const { return statistics_.revision() + values_.revision(); }

 private:
  using State = DeviceState;

  /// After so many unheard_waits_ everything is polled over the next connection.
  static constexpr int most_unheard_waits = 2;

  bool is_verified() const { return state_ >= State::verified; }
  /// Returns the state before.
  State note(DeviceEvent event) { return std::exchange(state_, after(state_, event)); }

  Time connect();
  Result<> ask_for_watchdog();
  Result<> prove_equal();
  Result<> judge(const Identity& identity);
  Result<> treat_as_foreign(const Error& error);
  void leave_out(const Identity& identity);
  void explain_silence(const Error& error);
  void listen();
  Result<> do_what_is_due(Time now);
  bool is_read_first(Time now) const { return wrote_last_ && poller_.is_overdue(now); }
  Result<> write();
  Result<> read_or_write();
  Result<> read(Time until);
  Result<> go_on_without(const Error& error);
  Result<> ask_alone();
  bool reopens(const Error& error);
  Result<> connect_only();
  void cycle_ended();
  Result<> connect_again();
  Result<> serve_watchdog();
  Time due() const;
  Time keep_alive_due() const {
    return listener_.is_active() || !keeps_alive_ ? Time::max()
                                                  : link_.last_answer() + map_.connection.timeout;
  }
  bool needs_keep_alive() const;
  void answered();
  void came_online();
  void lost(const Error& error);
  /// Limits the log lines about a connection that comes and goes.
  void tell(Level level, std::string text);
  void tell_what_waits();

  Map map_;
  Verify verify_;
  bool only_looks_;
  bool keeps_alive_ = needs_keep_alive();
  MapLoader load_;
  Link& link_;
  Clock& clock_;
  Sink& sink_;
  DeviceStatistics statistics_;
  ValueTable& values_;
  CouplerWatchdog watchdog_;
  Writer writer_;
  Poller poller_;
  OutputScheduler scheduler_;
  ChangeListener listener_;
  Backoff backoff_;

  LogLineLimit lines_{std::chrono::seconds(10), 6};
  Level level_ = Level::info;  ///< of the newest line
  bool holds_line_ = false;    ///< a line waits to be logged
  std::atomic<bool> ending_{false};
  State state_ = State::closed;
  bool wrote_last_ = false;  ///< the last request was a write: an overdue read goes before the next one
  bool is_closed_ = false;   ///< the device has closed the connection: the next read connects again
  std::optional<std::uint64_t> replies_at_reopen_;  ///< Link::replies() at the last call of reopens()
  std::uint64_t replies_at_connect_ = 0;            ///< Link::replies() when the maps were verified
  /// A verified device is online at once, unless it answered nothing else the last time: `online` would
  /// flicker.
  bool identity_suffices_ = true;
  /// The number of connections in a row that ended before the first wait was answered. One of them may be
  /// chance.
  int unheard_waits_ = 0;
  Time retry_at_ = Time::min();
  std::string last_error_kind_;           ///< that of the last attempt; the same kind is logged once
  std::optional<bool> answers_identity_;  ///< whether the device answers the question for its identity
  std::vector<ForeignPoint> left_out_;    ///< see Purpose
  bool explains_silence_ = true;  ///< false once the identity was answered, or silence_text() was logged
  bool is_node_ = false;          ///< the device is a node of this project, as far as it was asked
  identity::Further node_;        ///< what the node says of itself; empty if it is no node
  std::string peer_;              ///< the machine that the node runs on, if it says so
  std::uint64_t reported_fingerprint_ = 0;  ///< the fingerprint of the map whose differences have been logged
  std::optional<Time> reported_difference_at_;
};

}  // namespace coupler::host
