// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <future>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "coupler/host/core/clock.hpp"
#include "coupler/host/core/device.hpp"

namespace coupler::host {

/// The points that are to be read: any thread sets them, and the connection's thread takes them.
class ReadDemand {
 public:
  void set(std::uint32_t point, bool wanted) {
    const std::lock_guard lock(mutex_);
    given_.emplace_back(point, wanted);
    any_ = true;
  }

  /// Calls f(point, wanted), in order, for what was set since the last call.
  template <class F>
  void take(F&& f) {
    if (!any_ && taken_.empty()) return;
    {
      const std::lock_guard lock(mutex_);
      taken_.insert(taken_.end(), given_.begin(), given_.end());
      given_.clear();
      any_ = false;
    }
    while (next_ < taken_.size()) {
      const auto [point, wanted] = taken_[next_++];  // f may throw
      f(point, wanted);
    }
    taken_.clear();
    next_ = 0;
  }

 private:
  std::atomic<bool> any_{false};
  std::mutex mutex_;
  std::vector<std::pair<std::uint32_t, bool>> given_;
  std::vector<std::pair<std::uint32_t, bool>> taken_;  ///< a member, so that its memory is used again
  std::size_t next_ = 0;                               ///< of taken_: those before have been passed on
};

/// Runs a device in a thread of its own, so that a dead device slows no other. That thread owns the
/// connection, and only it receives. While it waits, another thread may send a write itself, and the reply
/// wakes the owner. So a write to an idle device needs no switch of threads.
class DeviceThread {
 public:
  /// Everything given by reference must outlive it. No request is sent before start().
  DeviceThread(const Map& map, Purpose purpose, MapLoader load, Link& link, ValueTable& values, Sink& sink);
  /// Ends the request in progress and waits for the thread. That takes milliseconds. If outputs have to get
  /// their safe values, it takes most of a second at the worst, or a tenth of a second for a device that is
  /// offline.
  ~DeviceThread() { end(); }
  DeviceThread(const DeviceThread&) = delete;
  DeviceThread& operator=(const DeviceThread&) = delete;
  /// Call it once, from any thread. After end() it does nothing. Throws std::system_error if no thread can be
  /// started.
  void start();
  /// Does what the destructor does. Call it once, from any thread. Returns false if an output should have its
  /// safe value but does not.
  bool end();

  // Any thread may call these functions after start(), and want() before. None of them waits for a request.

  /// Sends a write at once if the connection is idle, or else queues it. The sink may call it.
  void write(const Write& write);
  /// The same for several ordered writes: see Writer.
  void write_together(Span<const Write> writes);
  /// Counts a value that is not valid for its point, and reports it to the listener.
  void refuse(const Write& write, std::string_view why) { device_.refuse(write, why); }
  /// See Writer. Call it a few times a second.
  void report_held_back() { device_.report_held_back(); }
  /// Sets whether somebody wants the values of a point (index into Map::points). At first all are wanted. If
  /// a point whose changes are told was wanted already, it is read soon, because the new reader has seen none
  /// of its values.
  void want(std::uint32_t point, bool wanted);
  /// Resets the coupler's own watchdog. The answer comes after a few timeouts at most.
  std::future<CallAnswer> reset_watchdog();
  /// Writes the safe values. The answer comes after the request in flight and these writes, or at once if
  /// there is no connection.
  std::future<CallAnswer> make_safe();
  /// The answer comes a timeout after the end of the writes and requests before it, at the latest, or at once
  /// if there is no connection. The outcome goes to the sink.
  std::future<ScheduleAnswer> schedule(const ScheduledWrite& what);
  /// The same; `give` gets the answer, perhaps before this returns and before the outcome or after it. It
  /// must not wait for anything.
  void schedule(const ScheduledWrite& what, Reply<ScheduleAnswer>::Give give);
  /// Cancels a write that schedule() has accepted and that has not begun. The answer comes as that of
  /// schedule() does.
  std::future<CallAnswer> cancel_scheduled(std::uint32_t number);
  /// Cancels all these writes at one stroke: see OutputScheduler. `give` gets the answer as that of
  /// schedule() does.
  void cancel_all(WritesFrom which, Reply<CallAnswer>::Give give);
  /// Returns the writes that schedule() has accepted and that have no outcome yet.
  std::vector<WaitingWrite> scheduled() const { return device_.scheduled(); }
  DeviceSnapshot statistics() const { return device_.statistics(); }
  std::uint64_t revision() const { return device_.revision(); }

 private:
  void run();
  Time step();
  void send_queued();
  bool send_now();
  template <class Work>
  Time attempt(Work work);
  /// Closes the connection. Returns when to call step() again.
  Time give_up(const std::exception_ptr& thrown);
  void await_stop();

  Link& link_;
  Device device_;
  ReadDemand demand_;
  bool ends_safely_;           ///< the device writes safe values at the end
  std::mutex turn_;            ///< held by the thread that uses the connection; only the owner waits for it
  std::exception_ptr thrown_;  ///< by another thread while it held turn_
  std::atomic<bool> stopping_{false};
  std::atomic<bool> is_ending_{false};    ///< the thread only sets outputs to their safe values
  std::atomic<bool> is_over_{false};      ///< nothing is sent any more
  std::atomic<std::thread::id> owner_{};  ///< the thread that holds turn_ while it calls the sink
  std::promise<void> stopped_;
  bool ended_safely_ = true;  ///< valid once the thread has ended
  std::mutex life_;           ///< held while the thread is started or ended
  std::thread thread_;        // last: it uses the others
};

}  // namespace coupler::host
