// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

#include "coupler/device/core/log.hpp"
#include "coupler/device/core/server.hpp"
#include "coupler/device/net/loop.hpp"
#include "coupler/device/net/open_connection.hpp"
#include "coupler/device/net/waiters.hpp"
#include "coupler/map/network.hpp"
#include "coupler/modbus/frame.hpp"

namespace coupler::device {

/// One client. In a turn it receives once, at most as much as the longest frame, and answers what that
/// completes; so clients that pipeline thousands of requests take turns with the others. While a reply waits
/// for the client to read, no further request of it is carried out or received, so its replies are bounded.
/// While its request waits for changes, it is one of the waiters. Its memory is used again for the next
/// client.
class Connection final : public EventHandler {
 public:
  /// The time limit for the rest of a frame whose beginning has come, and for a client to take a reply. It is
  /// absolute, so that single bytes do not extend it.
  static constexpr std::chrono::seconds timeout{5};

  Connection(Loop& loop, Server& server, Waiters& waiters, Statistics& statistics, Log& log)
      : loop_(loop), server_(server), waiters_(waiters), statistics_(statistics), log_(log) {}
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() { close(); }

  /// Takes over a connected, non-blocking socket of a client from there (origin_of()).
  void open(Descriptor socket, const IpAddress& origin, TimePoint now);
  /// Continues with a client that another connection released.
  void open(OpenConnection from, const IpAddress& origin, TimePoint now);
  /// Answers what it waits for, and releases the client without closing its connection.
  OpenConnection release();
  /// Answers what it waits for, since the node ends.
  void end_wait();
  bool is_open() const { return socket_.is_open(); }
  void close();

  void ready(TimePoint now) override { have_turn(now, Receives::yes); }
  /// Answers a wait that may be due. It does not look at the socket: the loop reports when bytes have come.
  void answer_wait(TimePoint now) { have_turn(now, Receives::no); }

  /// When it is closed unless something happens; nullopt: never.
  std::optional<TimePoint> deadline() const { return deadline_; }

  /// It has sent at least one whole frame.
  bool has_asked() const { return has_asked_; }
  /// It has written an output.
  bool has_written() const { return session_.has_written; }
  const IpAddress& origin() const { return origin_; }
  /// A text for people: "10.0.0.6", or with TLS "'cell1' (10.0.0.6, operator)".
  std::string who() const;
  /// The time of its last whole frame, or of its beginning.
  TimePoint last_active() const { return last_active_; }

 private:
  static constexpr std::size_t output_size = longest_unsent;
  enum class Waiting { for_request, for_rest_of_frame, for_client_to_read };
  enum class Receives { no, yes };

  void have_turn(TimePoint now, Receives receives);
  bool take_turn(TimePoint now, Receives receives);
  bool receive();
  bool answer(TimePoint now);
  modbus::Framer::Outcome fill_output(TimePoint now);
  void put_waiting();
  void be_probed();
  void tell_of_tls();
  bool has_room() const;
  Span<std::uint8_t> room() { return Span<std::uint8_t>(output_).from(output_end_); }
  void list();
  void unlist();
  bool send();
  bool has_output() const { return output_begin_ != output_end_; }
  void set_deadline(TimePoint now, bool had_frame);

  Loop& loop_;
  Server& server_;
  Waiters& waiters_;
  Statistics& statistics_;
  Log& log_;
  Descriptor socket_;
  ClientSession session_;
  std::optional<TlsPeer> tls_;       ///< nullopt: a client without TLS
  std::optional<TimePoint> listed_;  ///< among the waiters, until then
  IpAddress origin_{};
  modbus::Framer framer_;
  std::array<std::uint8_t, output_size> output_;
  std::size_t output_begin_ = 0;
  std::size_t output_end_ = 0;
  bool ended_ = false;    ///< the client sends no more, but may wait for replies
  bool is_away_ = false;  ///< the firmware stands for a device that has gone
  bool has_asked_ = false;
  bool is_probed_ = false;  ///< its end is noticed soon
  TimePoint last_active_{};
  Waiting waiting_ = Waiting::for_request;
  std::optional<TimePoint> deadline_;
};

}  // namespace coupler::device
