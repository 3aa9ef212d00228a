// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "coupler/base/line_limit.hpp"
#include "coupler/host/core/calls.hpp"
#include "coupler/host/core/deadmen.hpp"
#include "coupler/host/core/device_statistics.hpp"
#include "coupler/host/core/paced_transport.hpp"
#include "coupler/host/core/point_quality.hpp"
#include "coupler/host/core/sink.hpp"
#include "coupler/host/core/write_queue.hpp"

namespace coupler::host {

/// Gets the writes that were carried out, in the connection's thread.
class WrittenListener {
 public:
  /// By a write of its own.
  virtual void on_written(const Write& write) = 0;
  /// These outputs have their safe values.
  virtual void on_made_safe(const std::vector<Write>& values) = 0;

 protected:
  ~WrittenListener() = default;
};

/// Writes to one device: sends what the queue holds, gives each write its result, and makes the writes of
/// deadmen, after a reconnect and at the end.
///
/// push(), refuse(), ask_safe() and report_held_back() may be called from any thread, all else only from the
/// one that uses the transport.
class Writer {
 public:
  /// Everything given by reference must outlive it.
  Writer(const Map& map, PacedTransport& transport, Clock& clock, DeviceStatistics& statistics,
         PointQualities& qualities, Sink& sink);

  /// Before anything is written.
  void listen(WrittenListener& listener) { written_ = &listener; }

  /// NaN and infinity are refused.
  void push(const Write& write);
  /// A value that is not valid for its point.
  void refuse(const Write& write, std::string_view why);
  /// Writes what `on_shutdown: safe` would, whatever that says: after the request in flight, and before all
  /// that waits. What waits for these points is superseded.
  std::future<Calls::Answer> ask_safe();
  /// Logs the lines about writes that were held back because there were too many. To be called now and then.
  void report_held_back();
  bool is_safe_asked() const { return safe_calls_.any(); }
  /// As WriteQueue's, from any thread.
  std::uint32_t queued(std::uint32_t point) const { return queue_.queued(point); }
  /// As WriteQueue's; one that was taken from there has none yet.
  bool has_results(std::uint32_t point, std::uint32_t queued) const {
    const auto is_taken = [point](const Write& write) { return write.point == point; };
    const std::vector<Write>& taken = batch_.writes();
    return queue_.has_results(point, queued) && std::none_of(taken.begin(), taken.end(), is_taken);
  }

  /// Sends the next writes without waiting for the answer, if nothing is in flight and no pause or reading
  /// must come first. True if there is nothing else to do until the answer has come.
  bool send_now();
  /// An answer is to come to what send_now() has sent, or it could not.
  bool awaits_answer() const { return is_sent_ || send_error_; }

  /// When step() has something to do; the past if it has now.
  Time due() const {
    return batch_.empty() && queue_.empty() && !is_safe_asked() ? deadmen_.due() : Time::min();
  }
  /// Waits for the answer to what is in flight, or makes the next request and waits for its answer. An error
  /// means that the connection can no longer be used; an exception is not an error.
  Result<> step();

  /// A new connection, or a coupler whose watchdog had switched its outputs off: under
  /// `on_reconnect: restore` they get their last values.
  Result<> reconnected();
  /// The device is a node of this project, which knows every function: exception 01 is about rights.
  void talks_to_node(bool is_node) { is_node_ = is_node; }
  /// An output has this value now, by another way than a write: `on_reconnect: restore` brings it back.
  void remember(const Write& write);
  /// There is no connection: all that was sent or queued gets its result.
  void disconnected(const Error& why);
  /// Does what `on_shutdown` says, last before the connection is closed. False if an output should have its
  /// safe value but does not.
  bool shut_down(bool connected);

  /// A newer value of the point waits to be written than the one just read, which would flicker back. Where
  /// writes never end, one value is shown after each that was acknowledged.
  bool hides(std::uint32_t point) const { return queue_.is_pending(point) && !acknowledged_[point]; }
  bool hides_any() const { return queue_.any_pending(); }
  /// Values of these points have been shown.
  void shown(const std::vector<std::uint32_t>& points) {
    for (const std::uint32_t point : points) acknowledged_[point] = false;
  }

  /// A write ended the last connection, and would be restored: it is to be seen first that the device answers
  /// anything, since otherwise that is no fault of the write.
  bool has_suspects() const { return !suspects_.empty(); }

  /// How many writes were dropped since the last call.
  std::uint64_t take_dropped() { return std::exchange(dropped_, 0); }

 private:
  void fire_deadmen();
  void wait_again();
  Result<> not_sent(const Error& why);
  Result<> finish(const Result<>& answer);
  /// `link`: what has become of the connection since the answer.
  Result<> finish_one(const Write& write, const Result<>& answer, const Result<>& link = {});
  Result<> verify(const Write& write, const Result<>& link);
  Result<> restore();
  Time deadman_due(std::uint32_t point, bool is_away) const;
  void suspect(const std::vector<Write>& writes, const Error& why);
  Result<> make_safe();
  Result<std::vector<RejectedValue>> write_safe_values();
  void tell(const Write& write, const WriteResult& result);
  void settle(const Write& write, const WriteResult& result);
  void report(const Write& write, const WriteResult& result);
  void drop(const Write& write);
  void drop_late();
  bool restores(const Write& write) const {
    return map_.on_reconnect == OnReconnect::restore && !is_pulsed(map_.points[write.point]);
  }
  std::string_view name(std::uint32_t point) const { return map_.points[point].name; }

  const Map& map_;
  PacedTransport& transport_;
  Clock& clock_;
  DeviceStatistics& statistics_;
  PointQualities& qualities_;
  Sink& sink_;
  WrittenListener* written_ = nullptr;
  WriteQueue queue_;
  Deadmen deadmen_;
  std::map<std::uint32_t, Write> last_written_;  ///< by point, for `on_reconnect: restore`
  std::set<std::uint32_t> suspects_;             ///< points whose last write ended the connection
  std::vector<Write> safe_values_;
  std::vector<bool> is_safe_point_;  ///< by point: safe_values_ has one
  Calls safe_calls_;
  std::vector<bool> acknowledged_;   ///< by point: a write, and no value has been shown since
  WriteBatch batch_;                 ///< in flight
  WriteBatch done_;                  ///< answered; kept for its memory
  bool is_sent_ = false;             ///< batch_ is, by send_now()
  std::optional<Error> send_error_;  ///< why send_now() could not send
  bool is_node_ = false;
  bool merges_ = true;  ///< the device takes several values in one request
  std::uint64_t dropped_ = 0;
  std::array<LineLimit, WriteResult::outcomes> lines_;  ///< by outcome
};

}  // namespace coupler::host
