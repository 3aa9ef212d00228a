// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bitset>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "coupler/base/span.hpp"
#include "coupler/host/core/channel.hpp"
#include "coupler/host/core/request_counts.hpp"
#include "coupler/host/core/stamp.hpp"
#include "coupler/host/core/turn_order.hpp"
#include "coupler/map/map.hpp"
#include "coupler/modbus/client.hpp"
#include "coupler/modbus/range.hpp"
#include "coupler/modbus/scheduled_output.hpp"

namespace coupler::host {

/// A channel, and the turns that links take on it. Only the link that has the turn may use `is_open`,
/// `opened` and `answered`.
struct SharedChannel {
  explicit SharedChannel(std::shared_ptr<Channel> of) : channel(std::move(of)) {}

  const std::shared_ptr<Channel> channel;
  Turns turns;
  bool has_several_links = false;  ///< set before the first one connects
  bool is_open = false;
  std::atomic<int> users{0};             ///< links that are connected
  std::atomic<std::uint64_t> losses{0};  ///< how often the peer has ended it, or could not be reached
  Time opened{};
  Time answered{};  ///< the last request
};

/// Receives the answers to waits for changes.
class WaitListener {
 public:
  virtual ~WaitListener() = default;
  /// Called before the reply to a request that was sent after the wait is used: that reply is newer.
  virtual void on_wait_answer(const WaitAnswer& answer) = 0;
};

/// Receives a line for each request: what it was, its result, and how long it took.
struct Trace {
  std::function<bool()> is_wanted;
  std::function<void(const std::string& line)> write;
};

/// A client's connection to one unit of a Modbus device. One request is in flight at a time, and its reply is
/// awaited for the device's timeout at most. Requests keep the pauses that some devices need: `connect_delay`
/// after a connect, `request_gap` between a reply and the next request.
///
/// Several links may share one channel, request by request: writes go first, also those of a unit whose own
/// read waits for its turn. If a unit stays silent its reply may still come.
/// On a bus that unit rests for a timeout while others are asked; otherwise the shared channel is closed, and
/// the next request reopens it. If the peer ends the connection, or the port goes, all units have lost it:
/// the devices behind it may have changed.
///
/// The object belongs to one thread. Another thread may call reserve(), give_back() and send() while a lock
/// of its own guarantees that the owner is in wait_until(). Any thread may call interrupt(), wake(),
/// discarded(), certificates(), counts() and unit_answers().
class Link {
 public:
  /// `clock` is the machine's if it is null.
  Link(std::shared_ptr<SharedChannel> shared, const Connection& unit, const Limits& limits,
       Clock* clock = nullptr);
  ~Link() { close(); }
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  Clock& clock() const { return clock_; }
  /// Sets the unit of the requests that follow, and the time within which it must reply.
  void select(std::uint8_t unit, std::chrono::milliseconds timeout) {
    if (unit != unit_) late_until_ = {};
    unit_ = unit;
    timeout_ = timeout;
  }
  /// Sets the receiver of the answers to waits for changes.
  void listen(WaitListener& listener) { listener_ = &listener; }
  void trace(Trace trace) { trace_ = std::move(trace); }

  Result<> connect();
  void close();
  /// Ends the call in progress. That call and every later one fail at once.
  void interrupt();

  /// Sends a PDU and waits for the reply. Returns the PDU of the reply, which has passed
  /// modbus::check_reply() and is valid until the next request. An exception is an ExceptionReply. A reply to
  /// a read that came after the timeout is a Timeout.
  Result<modbus::Bytes> exchange(modbus::Bytes pdu);
  /// Sends a write, and does not wait for its confirmation. receive() must follow before any other request.
  Result<> send(const modbus::WriteRequest& request);
  /// Waits for the confirmation of a write, until a timeout after the request at most.
  Result<> receive();

  // Requests, and what their replies mean (link_requests.cpp).

  /// FC 1 … 4: fills `values` with `range.count()` registers (at most 125), or bits as 0 or 1 (at most 2000).
  Result<> read(Table table, modbus::Range range, std::uint16_t* values);
  /// Does the same, in a request that is as large as Map::read_whole requires.
  Result<> read_as_mapped(const Map& map, Table table, modbus::Range range, std::uint16_t* values);
  /// Does the same as read(), but returns false after an exception: the device does not have them. The
  /// exception is counted as a reply only, unless it says that the unit is away.
  Result<bool> read_if_mapped(Table table, modbus::Range range, std::uint16_t* values);
  /// FC 20 with one group: fills `registers` (1 … 121) from a file.
  Result<> read_file_record(std::uint16_t file, std::uint16_t record, Span<std::uint16_t> registers);
  /// FC 66. Only a node understands it, and only over a connection that can_wait().
  Result<modbus::ScheduleReply> schedule(const modbus::ScheduleRequest& request);
  /// Reads, only to see whether the device answers. An exception is an answer, unless it says that the unit
  /// is away.
  Result<> ask(const TableRange& place);
  /// Does the same with the first readable point; if there is none, with the first point; in a map without
  /// points, with coil 0.
  Result<> keep_alive(const Map& map);

  // Turns of links that share a channel.

  /// Sets the rank of exchange(); send() always has Rank::write. Rank::safe also claims all turns for this
  /// link, until another rank is set.
  void rank(Rank rank);
  enum class Turn { none, read, write };
  /// Waits until a read would be sent at once, or a write if `write_waits`, whichever comes first. That
  /// request or another call must follow. Returns Turn::none if no turn was free before wake() or `until`;
  /// Turn::read, without a turn, if the read would fail at once.
  Turn await_turn(Time until, bool write_waits = false);
  /// Waits for a turn to write, until `ends()` is true or send() would fail. Calls `ends()` only if it must
  /// wait: first at once, then at least after each wake(). A request or give_back() must follow.
  void await_turn_to_write(const std::function<bool()>& ends);
  /// Takes the turn if send() need not wait, and returns whether it did so. After true, send() or give_back()
  /// must follow.
  bool reserve();
  /// Gives the turn to the other links, because no request follows.
  void give_back();

  // A wait for changes (function code 65): see Channel.

  /// Returns false where links share the channel, and on a serial line.
  bool can_wait() const { return !shared_->has_several_links && channel().can_wait(); }
  Result<> send_wait(const modbus::ChangesRequest& request);
  /// Hands the answer to the listener.
  Result<> receive_wait();
  /// See Channel.
  Result<> discard_unasked() { return channel().discard_unasked(); }

  /// Returns when bytes have come or the connection has ended, where the link has a channel by Modbus/TCP for
  /// itself; after wake() or interrupt(); or at `time`.
  Woken wait_until(Time time);
  /// Ends the wait_until() in progress, or else the next one.
  void wake();

  /// The number of received bytes that were late or did not belong to a reply, for all links of the channel.
  std::uint64_t discarded() const { return channel().discarded(); }
  /// The certificates of the last connection; nullopt if it had no TLS.
  std::optional<Certificates> certificates() const { return channel().certificates(); }
  RequestCounts counts() const {
    const std::lock_guard lock(counts_mutex_);
    return counts_;
  }
  /// Returns whether the last request over this connection was answered by the unit, and not by a gateway for
  /// a unit that is away.
  bool unit_answers() const { return unit_answers_; }

  /// Returns whether a request needs no pause now.
  bool is_ready() const { return ready_ == Time::min() || clock_.now() >= ready_; }
  /// The time of the reply to the last request, or of its failure.
  Time last_answer() const { return answered_; }
  /// The stamp of the values in the last reply to a read, between the times of request and reply.
  Stamp last_stamp() const { return stamp_between(sent_at_, answered_); }
  /// The stamp of the last write, between the times of its request and reply. If receive() failed, the write
  /// may not have been carried out.
  Stamp last_write() const { return written_; }
  /// The number of requests that were answered, also by an exception.
  std::uint64_t replies() const { return replies_; }
  /// Returns whether a request was answered with this exception since the last forget_exceptions().
  bool has_seen(modbus::Exception code) const { return seen_[static_cast<std::size_t>(code)]; }
  void forget_exceptions() { seen_.reset(); }

 private:
  Channel& channel() const { return *shared_->channel; }
  bool is_lost() const { return is_connected_ && losses_at_connect_ != shared_->losses; }
  /// Returns whether bytes end wait_until(): they are for this link, and no late reply on a bus.
  bool is_polled() const { return !shared_->has_several_links && !channel().is_bus(); }

  // Turns (link_turns.cpp).
  bool must_give_up() const { return interrupted_.is_set() || is_lost(); }
  tl::unexpected<Error> give_up_error() const;
  Result<> take_turn(Rank rank);
  void release();

  /// Opens the channel anew, in its turn.
  Result<> open();
  /// No request is sent over the channel before. Only for the link that has the turn.
  Time channel_ready() const { return std::max(shared_->opened + delay_, shared_->answered + gap_); }
  void pause_until(Time time);
  /// The next request of this link is sent no sooner than `pause` after `time`.
  void pause_after(Time time, Duration pause);
  /// Waits for the pause and the turn, and makes the channel ready for a request.
  Result<> begin(Rank rank);
  Result<> prepare();
  /// begin(), and sends a request. `owner_waits`: the owner is in wait_until() meanwhile.
  Result<> put(Rank rank, modbus::Bytes pdu, bool owner_waits = false);
  /// Receives the reply, checks it, and gives the turn back.
  Result<modbus::Bytes> finish(bool is_read);
  Result<modbus::Bytes> receive_checked(bool is_read);
  void end_turn(Time now, const Error* error);
  /// Keeps a reply that may still come from being taken for the reply to a later request.
  void unanswered();
  /// Counts a request that has ended.
  void count(Time now, const Error* error);
  void trace_request(const Error* error) const;
  template <class Describe>
  void write_trace(const Error* error, Time begun, Describe describe) const;
  void hand_over(const std::optional<WaitAnswer>& answer);

  const std::shared_ptr<SharedChannel> shared_;
  std::uint8_t unit_;
  std::chrono::milliseconds timeout_;
  Duration gap_;
  Duration delay_;
  std::unique_ptr<SteadyClock> own_clock_;
  Clock& clock_;
  WaitListener* listener_ = nullptr;
  Trace trace_;

  Event interrupted_;
  Wakeup wakeup_;
  std::atomic<bool> is_woken_{false};  ///< wake() was called, and the owner has not seen it yet
  Rank rank_ = Rank::read;
  bool may_be_refused_ = false;  ///< the request in progress is that of read_if_mapped()
  bool is_connected_ = false;
  std::uint64_t losses_at_connect_ = 0;  ///< SharedChannel::losses then
  bool has_turn_ = false;                ///< for the request that follows
  bool is_reserved_ = false;             ///< by reserve()

  std::array<std::uint8_t, modbus::max_pdu_size> request_{};  ///< the last one
  std::size_t request_size_ = 0;
  std::array<std::uint8_t, modbus::max_pdu_size> reply_{};  ///< a copy, if links share the channel
  Time ready_ = Time::min();                                ///< no request is sent before
  Time late_until_{};  ///< on a bus, the unit's late reply may come until then
  Time sent_at_{};     ///< the last request
  Time answered_{};
  Stamp written_{};
  std::uint64_t replies_ = 0;
  std::atomic<bool> unit_answers_{false};
  std::bitset<256> seen_;  ///< the exceptions that came
  mutable std::mutex counts_mutex_;
  RequestCounts counts_;
};

}  // namespace coupler::host
