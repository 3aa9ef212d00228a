// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <future>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "coupler/host/core/clock.hpp"
#include "coupler/host/core/device.hpp"

namespace coupler::host {

/// Which points are to be read: set by any thread, taken by the connection's own.
class ReadDemand {
 public:
  void set(std::uint32_t point, bool wanted) {
    const std::lock_guard lock(mutex_);
    given_.emplace_back(point, wanted);
    any_ = true;
  }

  /// Calls f(point, wanted) for what was set since the last call, in order.
  template <class F>
  void take(F&& f) {
    if (!any_) return;
    {
      const std::lock_guard lock(mutex_);
      taken_.swap(given_);
      any_ = false;
    }
    for (const auto& [point, wanted] : taken_) f(point, wanted);
    taken_.clear();
  }

 private:
  std::atomic<bool> any_{false};
  std::mutex mutex_;
  std::vector<std::pair<std::uint32_t, bool>> given_;
  std::vector<std::pair<std::uint32_t, bool>> taken_;  ///< kept for its memory
};

/// Runs a device in its own thread, so that a dead one slows no other. That thread owns the connection, and
/// it alone receives. While it waits, another thread may send a write by itself; the answer wakes the owner.
/// So a write to an idle device needs no switch of threads.
class DeviceThread {
 public:
  /// With Poll::subscribed no point is wanted at first. Nothing is asked of the device before start().
  DeviceThread(const Map& map, Verify verify, MapLoader load, Transport& transport, Sink& sink,
               Poll poll = Poll::all);
  /// Ends the request in progress and waits for the thread: milliseconds, or, where outputs are to go to
  /// their safe values, most of a second at the worst; a tenth for a device that is offline.
  ~DeviceThread() { end(); }
  DeviceThread(const DeviceThread&) = delete;
  DeviceThread& operator=(const DeviceThread&) = delete;
  /// Once, in any thread; after end() it does nothing. Throws std::system_error if no thread can be had.
  void start();
  /// What the destructor does, once, in any thread. False if an output should have its safe value but does
  /// not.
  bool end();

  // From any thread, after start(); none of them waits for a request.

  /// Sends a write at once if the connection is idle, otherwise queues it. The sink may call it.
  void write(const Write& write);
  /// Counts a value that is not valid for its point, and reports it to the listener.
  void refuse(const Write& write, std::string_view why) { device_.refuse(write, why); }
  /// As Writer's. To be called a few times a second.
  void report_held_back() { device_.report_held_back(); }
  /// Whether somebody wants the values of a point (index into Map::points). One that is wanted still is read
  /// soon where its changes are told: somebody new has seen none of its values.
  void want(std::uint32_t point, bool wanted);
  /// Resets the coupler's own watchdog. The answer comes after a few timeouts at most.
  std::future<Calls::Answer> reset_watchdog();
  /// Writes what `on_shutdown: safe` would. The answer comes after the request in flight and these writes; at
  /// once if there is no connection.
  std::future<Calls::Answer> make_safe();
  /// The answer comes when the writes and requests before it are done, and a timeout after that at the
  /// latest; at once if there is no connection. The outcome goes to the sink.
  std::future<ScheduleAnswer> schedule(const ScheduledWrite& what);
  DeviceSnapshot statistics() const { return device_.statistics(); }
  std::vector<PointQuality> qualities() const { return device_.qualities(); }
  PointQuality quality(std::uint32_t point) const { return device_.quality(point); }
  std::uint64_t revision() const { return device_.revision(); }

 private:
  void run();
  Time step();
  void await_stop();

  Transport& transport_;
  SteadyClock clock_;
  Device device_;
  ReadDemand demand_;
  bool ends_safely_;  ///< writes safe values at the end
  std::mutex turn_;   ///< held by whoever uses the connection; only the owner waits for it
  std::atomic<bool> stopping_{false};
  std::atomic<bool> is_ending_{false};  ///< the thread makes no more steps, but puts outputs into safe states
  std::atomic<std::thread::id> owner_{};  ///< has its turn while it calls the sink
  std::promise<void> stopped_;
  bool ended_safely_ = true;  ///< once the thread has ended
  std::mutex life_;           ///< held to start and to end it
  std::thread thread_;        // last: it uses the others
};

}  // namespace coupler::host
