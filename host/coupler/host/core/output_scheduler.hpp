// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <future>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "coupler/host/core/call_queue.hpp"
#include "coupler/host/core/change_listener.hpp"
#include "coupler/host/core/node_outputs.hpp"
#include "coupler/host/core/output_canceller.hpp"
#include "coupler/host/core/scheduled.hpp"
#include "coupler/host/core/scheduled_writes.hpp"
#include "coupler/host/core/sink.hpp"
#include "coupler/host/core/writer.hpp"

namespace coupler::host {

/// A call that is answered once the writes queued before it for the same point have their results: another
/// write to the point would cancel it.
struct AskedSchedule {
  ScheduledWrite what;
  std::uint32_t after = 0;  ///< WriteQueue::queued()
  std::uint64_t order = 0;  ///< among all calls
};
using ScheduleCalls = CallQueue<AskedSchedule, ScheduleAnswer>;

/// A call that cancels writes, also those whose calls came before and are not answered yet.
struct AskedCancel {
  WritesFrom which;
  std::uint64_t after = 0;  ///< AskedSchedule::order of the last of them
};

/// Scheduled writes. A node with a timer carries them out and tells their outcome; otherwise the driver
/// writes them.
///
/// Any thread may call ask(), cancel(), cancel_all(), waiting() and is_busy(). Only the thread that uses the
/// link may call the other functions.
class OutputScheduler : private ScheduledListener, private WrittenListener {
 public:
  /// `bits` receives the changes of bits. All references must outlive the object.
  OutputScheduler(const Map& map, Link& link, Writer& writer, ChangeSink& bits, Sink& sink);

  /// Schedules a write to a writable point. It is refused while there is no connection, and cancelled if the
  /// connection ends before its time.
  std::future<ScheduleAnswer> ask(const ScheduledWrite& what) {
    return calls_.ask({what, writer_.queued(what.write.point), ++asked_});
  }
  void ask(const ScheduledWrite& what, Reply<ScheduleAnswer>::Give give) {
    calls_.ask({what, writer_.queued(what.write.point), ++asked_}, std::move(give));
  }
  /// Cancels a write that was accepted and has not begun. Its outcome goes to the sink.
  std::future<CallAnswer> cancel(std::uint32_t number) { return cancels_.ask(number); }
  /// Cancels all these writes, whoever carries them out. A call of ask() that waits is refused if it came
  /// before. Success means that none of them will be carried out any more; the outcomes have been given to
  /// the sink then. What is asked for afterwards stays.
  void cancel_all(WritesFrom which, Reply<CallAnswer>::Give give) {
    point_cancels_.ask({std::move(which), asked_}, std::move(give));
  }
  /// Returns those that were accepted and have no outcome yet, in the order in which they are due.
  std::vector<WaitingWrite> waiting() const;
  /// Returns whether shut_down() has something to do.
  bool is_busy() const { return busy_; }

  /// The receiver of what a node tells.
  ChangeSink& changes() { return by_node_; }

  /// Starts with a new connection. `by_node`: it leads to a node that carries out scheduled outputs.
  void connected(bool by_node);
  /// The time at which queue_due() or step() has something to do. It is in the past if that is now, or as
  /// soon as the writer has made the writes before.
  Time due(const ChangeListener& listener) const {
    const bool is_asked = withdraws() || (calls_.any() && is_ready(listener));
    return is_asked ? Time::min() : by_driver_.due();
  }
  /// Queues the writes whose time has come.
  void queue_due(Time now) {
    if (!busy_) return;
    by_driver_.queue_due(now);
    note();
  }
  bool has_request(const ChangeListener& listener) {
    if (withdraws()) return true;
    // The writer restores first what it owes: that would cancel an output which the device has accepted.
    return is_ready(listener) && !writer_.owes() &&
           calls_.any_of([this](const AskedSchedule& asked) { return is_next(asked); });
  }
  /// Sends one request. An error means that the connection can no longer be used.
  Result<> step(const ChangeListener& listener);
  /// Cancels what waits, because the connection has ended. The writer must know that already.
  void disconnected(const std::string& why);
  /// Cancels what waits, because the program ends. Call it before the connection is closed, if there is one.
  void shut_down(bool connected, const ChangeListener& listener);

 private:
  void on_outcome(const AcceptedWrite& which, ScheduledOutcome::Result result, Stamp at,
                  const std::string& reason) override;
  void on_written(const Write& write) override;
  void on_made_safe(const std::vector<Write>& values) override;
  bool withdraws() const override { return cancels_.any() || point_cancels_.any(); }

  /// A node can be given a time once its clock is known, which is soon: it answers the first wait for changes
  /// at once.
  bool is_ready(const ChangeListener& listener) const {
    return !node_can_ || !listener.is_active() || listener.has_heard();
  }
  std::string why_refused(const ScheduledWrite& what, Time now) const;
  bool can_node(const ScheduledWrite& what, const ChangeListener& listener) const;
  /// A call that came after one of cancel_all() is not accepted before it.
  bool is_next(const AskedSchedule& asked) const {
    return !point_cancels_.any() && writer_.has_results(asked.what.write.point, asked.after);
  }
  void refuse_waiting(const AskedCancel& cancelled);
  Result<> answer(const ScheduledWrite& what, Reply<ScheduleAnswer>& to, const ChangeListener& listener);
  /// Returns nullopt if the device does not do it.
  Result<std::optional<ScheduleAnswer>> give_to_node(const ScheduledWrite& what,
                                                     const ChangeListener& listener);
  ScheduleAnswer keep(const ScheduledWrite& what);
  std::uint32_t accept(const ScheduledWrite& what, bool by_device);
  modbus::ScheduleRequest request(const ScheduledWrite& what, modbus::NodeTime due,
                                  const ChangeListener& listener) const;
  bool is_full() const { return by_node_.size() + by_driver_.size() >= max_scheduled; }
  const Point& point(const ScheduledWrite& what) const { return map_.points[what.write.point]; }
  void note() { busy_ = by_node_.size() + by_driver_.size() > 0; }

  const Map& map_;
  Link& link_;
  Clock& clock_;
  Writer& writer_;
  Sink& sink_;
  ScheduleCalls calls_;
  CallQueue<std::uint32_t, CallAnswer> cancels_;  ///< by number
  CallQueue<AskedCancel, CallAnswer> point_cancels_;
  std::atomic<std::uint64_t> asked_{0};  ///< how often ask() was called
  ScheduledWrites by_driver_;
  NodeOutputs by_node_;
  OutputCanceller canceller_;
  bool node_can_ = false;  ///< the device carries out scheduled outputs
  std::uint32_t last_number_ = 0;
  std::atomic<bool> busy_{false};  ///< a write was accepted and has no outcome yet
  mutable std::mutex mutex_;
  std::vector<WaitingWrite> waiting_;  ///< guarded by mutex_
};

}  // namespace coupler::host
