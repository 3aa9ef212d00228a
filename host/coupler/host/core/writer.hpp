// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "coupler/base/log_line_limit.hpp"
#include "coupler/host/core/call_queue.hpp"
#include "coupler/host/core/deadmen.hpp"
#include "coupler/host/core/device_statistics.hpp"
#include "coupler/host/core/link.hpp"
#include "coupler/host/core/sink.hpp"
#include "coupler/host/core/value_table.hpp"
#include "coupler/host/core/write_queue.hpp"

namespace coupler::host {

/// Gets the writes that were carried out, in the connection's thread, and may withdraw writes of its own.
class WrittenListener {
 public:
  /// The point has been written by a write of its own.
  virtual void on_written(const Write& write) = 0;
  /// These outputs have been set to their safe values.
  virtual void on_made_safe(const std::vector<Write>& values) = 0;
  /// Returns whether no write may be sent before it has called Writer::withdraw().
  virtual bool withdraws() const = 0;

 protected:
  ~WrittenListener() = default;
};

/// Writes to one device: sends the queued writes, reports the result of each, and makes the writes of
/// deadmen, those after a reconnect and those at the end.
///
/// Any thread may call push(), push_together(), refuse(), ask_safe() and report_held_back(). Only the thread
/// that uses the link may call the other functions.
class Writer {
 public:
  /// All references must outlive the writer.
  Writer(const Map& map, Link& link, DeviceStatistics& statistics, ValueTable& values, Sink& sink);

  /// Before anything is written.
  void listen(WrittenListener& listener) { written_ = &listener; }

  /// Refuses NaN and infinity.
  void push(const Write& write);
  /// Pushes ordered writes that are to be sent one after the other, neighbours in one request. If one of them
  /// is refused, or there is no room for all, none is sent.
  void push_together(Span<const Write> writes);
  /// Reports a value that is not valid for its point.
  void refuse(const Write& write, std::string_view why);
  /// Writes the safe values, whatever `on_shutdown` says, after the request in flight and before all that is
  /// queued. Queued writes to these points are superseded.
  std::future<CallAnswer> ask_safe();
  /// Takes back a write that is still queued. Then its listener receives no result. Returns false if the
  /// write was sent, or has its result.
  bool withdraw(const WriteListener& listener);
  /// Logs the lines about writes that were held back because there were too many. Call it now and then.
  void report_held_back();
  bool is_safe_asked() const { return safe_calls_.any(); }
  /// See WriteQueue. Any thread may call it.
  std::uint32_t queued(std::uint32_t point) const { return queue_.queued(point); }
  /// See WriteQueue. A write that was taken from the queue has no result yet.
  bool has_results(std::uint32_t point, std::uint32_t queued) const {
    const auto is_taken = [point](const Write& write) { return write.point == point; };
    const std::vector<Write>& taken = batch_.writes();
    return queue_.has_results(point, queued) && std::none_of(taken.begin(), taken.end(), is_taken);
  }

  /// Sends the next writes without waiting for the reply, if nothing is in flight and no pause or read must
  /// come first. Returns true if nothing else is to be done until the reply comes.
  bool send_now();
  /// Returns whether the reply to what send_now() has sent is outstanding, or the error of send_now() is.
  bool awaits_answer() const { return is_sent_ || send_error_; }

  /// The time at which step() has something to do; it is in the past if that is now.
  Time due() const {
    return batch_.empty() && queue_.empty() && !is_safe_asked() && !owes_ ? deadmen_.due() : Time::min();
  }
  /// Waits for the reply to the request in flight, or sends the next request and waits for its reply. An
  /// error means that the connection can no longer be used. An exception is not an error.
  Result<> step();

  /// Writes the last values of all outputs under `on_reconnect: restore`, for a new connection, or for a
  /// coupler whose watchdog had switched its outputs off.
  Result<> reconnected();
  /// Returns whether step() restores an output that reconnected() has left to a newer value.
  bool owes() const { return owes_; }
  /// Notes that the device is a node of this project. A node knows every function, so exception 01 is about
  /// rights.
  void talks_to_node(bool is_node) { is_node_ = is_node; }
  /// Notes that an output has this value now without a write. `on_reconnect: restore` restores it.
  void remember(const Write& write);
  /// Reports a result for all that was sent or queued, because the connection has ended.
  void disconnected(const Error& why);
  /// Drops what has been queued since, because the program ends. Any thread may call it, once nothing is sent
  /// any more.
  void drop_all();
  /// Does what `on_shutdown` says, before the connection is closed. Returns false if an output should have
  /// its safe value but does not.
  bool shut_down(bool connected);

  /// Returns whether a newer value than the one just read waits to be written, so that the value read must
  /// not be published: it would flicker back. If writes never end, one value is published after each
  /// acknowledged write.
  bool hides(std::uint32_t point) const { return queue_.is_pending(point) && !acknowledged_[point]; }
  bool hides_any() const { return queue_.any_pending(); }
  /// Notes that values of these points have been published.
  void shown(const std::vector<std::uint32_t>& points) {
    for (const std::uint32_t point : points) acknowledged_[point] = false;
  }

  /// Returns whether a write ended the last connection and would be restored. Then the device has to answer
  /// another request first, since otherwise the write may not be at fault.
  bool has_suspects() const { return !suspects_.empty(); }

  /// Returns the number of writes that were dropped since the last call.
  std::uint64_t take_dropped() { return std::exchange(dropped_, 0); }

 private:
  std::string why_forbidden(const Write& write) const;
  void reject(const Write& write, const WriteResult& result);
  void fire_deadmen();
  void wait_again();
  Result<> not_sent(const Error& why);
  Result<> finish(const Result<>& answer);
  /// Completes the writes of done_ that have no result yet.
  Result<> finish_done(const Result<>& answer);
  void clear_done();
  /// `connection`: the state of the connection after the reply.
  Result<> finish_one(const Write& write, const Result<>& answer, const Result<>& connection = {});
  Result<> verify(const Write& write, const Result<>& connection);
  Result<> restore();
  Result<> restore(const std::vector<Write>& all);
  void note_owed(const Write& write, bool is_written);
  void forget_owed();
  std::vector<Write> take_owed();
  Time deadman_due(std::uint32_t point, bool is_away) const;
  void suspect(const std::vector<Write>& writes, const Error& why);
  void supersede_for_safe(std::vector<std::uint32_t>& deadmen);
  Result<std::vector<RejectedValue>> replace_by_safe_values(std::vector<std::uint32_t>& deadmen);
  Result<> make_safe();
  Result<std::vector<RejectedValue>> write_safe_values();
  void tell(const Write& write, const WriteResult& result);
  void settle(const Write& write, const WriteResult& result);
  void report(const Write& write, const WriteResult& result);
  void drop(const Write& write);
  void drop_late();
  bool withdraws() const { return written_ != nullptr && written_->withdraws(); }
  bool restores(const Write& write) const {
    const Point& point = map_.points[write.point];
    return map_.on_reconnect == OnReconnect::restore && !is_pulsed(point) &&
           tool_with_output(map_, point.name) == nullptr;  // it would move
  }
  std::string_view name(std::uint32_t point) const { return map_.points[point].name; }

  const Map& map_;
  Link& link_;
  Clock& clock_;
  DeviceStatistics& statistics_;
  ValueTable& values_;
  Sink& sink_;
  WrittenListener* written_ = nullptr;
  WriteQueue queue_;
  Deadmen deadmen_;
  std::map<std::uint32_t, Write> last_written_;  ///< by point; restored by `on_reconnect: restore`
  std::set<std::uint32_t> suspects_;             ///< points whose last write ended the connection
  /// Points that were not restored because a newer value waits. They are if that is not written.
  std::set<std::uint32_t> owed_;
  bool owes_ = false;  ///< the newer value for one of these was not written
  std::vector<Write> safe_values_;
  std::vector<bool> is_safe_point_;  ///< by point: safe values replace what waits for it; also of tools
  Calls safe_calls_;
  std::vector<bool> acknowledged_;   ///< by point: a write was acknowledged, and no value was published since
  WriteBatch batch_;                 ///< in flight
  WriteBatch done_;                  ///< answered; a member, so that its memory is used again
  std::size_t told_ = 0;             ///< so many of done_ have their result
  bool is_settled_ = false;          ///< settle() was called since finish_one() began
  bool is_sent_ = false;             ///< batch_ has been sent by send_now()
  std::optional<Error> send_error_;  ///< why send_now() could not send
  bool is_node_ = false;
  bool merges_ = true;  ///< the device takes several values in one request
  std::uint64_t dropped_ = 0;
  std::array<LogLineLimit, WriteResult::outcomes> lines_;  ///< by outcome
};

}  // namespace coupler::host
