// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <utility>

#include "coupler/base/line_limit.hpp"
#include "coupler/host/core/calls.hpp"
#include "coupler/host/core/deadmen.hpp"
#include "coupler/host/core/device_statistics.hpp"
#include "coupler/host/core/paced_transport.hpp"
#include "coupler/host/core/point_quality.hpp"
#include "coupler/host/core/sink.hpp"
#include "coupler/host/core/write_queue.hpp"
#include "coupler/host/core/write_values.hpp"
#include "coupler/host/core/written_values.hpp"

namespace coupler::host {

/// What writes to one device: sends what the queue holds, tells each write its result, and makes the writes
/// that nobody asked for at that moment: those of deadmen, after a reconnect, at the end.
///
/// push(), refuse() and ask_safe() may come from any thread. All others belong to the one who uses the
/// transport.
class Writer {
 public:
  /// What `map` views, and everything given by reference, must outlive it.
  Writer(const Map& map, PacedTransport& transport, Clock& clock, DeviceStatistics& statistics,
         PointQualities& qualities, Sink& sink);

  /// NaN and infinity are refused.
  void push(const Write& write);
  /// A value that is none of its point.
  void refuse(const Write& write, std::string_view why);
  /// Writes what `on_shutdown: safe` would, whatever that says: after the request in flight, and before all
  /// that waits. What waits for these points is superseded.
  std::future<Calls::Answer> ask_safe();
  /// Lines about writes of which there were too many to say them at once. From any thread, now and then.
  void report_held_back();
  bool is_safe_asked() const { return safe_calls_.any(); }

  /// Sends the next writes without waiting for the answer, if nothing is in flight and no pause or reading
  /// must come first. True if there is nothing else to do until the answer has come.
  bool send_now();
  /// An answer is to come to what send_now() has sent.
  bool awaits_answer() const { return sent_.has_value(); }

  /// When step() has something to do; the past if it has now.
  Time due() const {
    return batch_.empty() && queue_.empty() && !is_safe_asked() ? deadmen_.due() : Time::min();
  }
  /// Awaits the answer to what is in flight, or makes the next request and awaits that. An error means that
  /// the connection is of no more use; an exception is none.
  Result<> step();

  /// A new connection, or a coupler whose watchdog had switched its outputs off: under
  /// `on_reconnect: restore` they get their last values.
  Result<> reconnected();
  /// There is no connection: nobody waits for what was sent or queued.
  void disconnected(const Error& why);
  /// As `on_shutdown` says, the last thing before the connection is closed. False if an output should have
  /// its safe value and has not.
  bool shut_down(bool connected);

  /// A newer value of the point is on its way than the one just read, which would flicker back. Where writes
  /// follow each other without end, one value is shown after each that was acknowledged.
  bool hides(std::uint32_t point) const { return queue_.is_pending(point) && !acknowledged_[point]; }
  bool hides_any() const { return queue_.any_pending(); }
  /// Values of these points have been shown.
  void shown(const std::vector<std::uint32_t>& points) {
    for (const std::uint32_t point : points) acknowledged_[point] = false;
  }

  /// Writes that were dropped since the last call of it.
  std::uint64_t take_dropped() { return std::exchange(dropped_, 0); }

 private:
  void fire_deadmen();
  Result<> finish(const Result<>& answer);
  Result<> finish_one(const Write& write, const Result<>& answer);
  Result<> verify(const Write& write);
  Result<> make_safe();
  Result<std::vector<RefusedValue>> write_safe_values();
  void tell(const Write& write, const WriteResult& result);
  void settle(const Write& write, const WriteResult& result);
  void report(const Write& write, const WriteResult& result);
  void drop(const Write& write);
  std::string_view name(std::uint32_t point) const { return map_.points[point].name; }

  Map map_;
  PacedTransport& transport_;
  Clock& clock_;
  DeviceStatistics& statistics_;
  PointQualities& qualities_;
  Sink& sink_;
  WriteQueue queue_;
  Deadmen deadmen_;
  WrittenValues values_;
  std::vector<Write> safe_values_;
  std::vector<bool> is_safe_point_;  ///< by point: safe_values_ has one
  Calls safe_calls_;
  std::vector<bool> acknowledged_;            ///< by point: a write, and no value has been shown since
  WriteBatch batch_;                          ///< in flight, or next
  WriteBatch done_;                           ///< answered; kept for its memory
  std::optional<modbus::WriteRequest> sent_;  ///< batch_, where send_now() has sent it
  std::optional<Error> send_error_;           ///< it could not be sent
  bool merges_ = true;                        ///< the device takes several values in one request
  std::uint64_t dropped_ = 0;
  std::array<LineLimit, WriteResult::outcomes> lines_;  ///< by outcome
};

}  // namespace coupler::host
