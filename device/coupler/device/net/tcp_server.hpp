// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "coupler/device/core/log.hpp"
#include "coupler/device/net/connection.hpp"
#include "coupler/device/net/listener.hpp"

namespace coupler::device {

/// Accepts clients, up to a fixed number of connections, and closes those that time out. When all are in use,
/// one of the address that has the most is closed: first one that never sent a request, then one that never
/// wrote an output, then the longest idle. Allocates at the start only.
class TcpServer : public EventHandler {
 public:
  static constexpr std::size_t max_connections = 256;

  /// `capacity` is lowered to what the limit of open files leaves. All of them outlive it.
  TcpServer(Loop& loop, const Listener& listener, Server& server, Statistics& statistics, Log& log,
            std::size_t capacity = max_connections);
  TcpServer(const TcpServer&) = delete;
  TcpServer& operator=(const TcpServer&) = delete;
  ~TcpServer();

  const std::string& name() const { return listener_.name; }
  std::size_t capacity() const { return connections_.size(); }
  /// Connections that are open now.
  std::size_t size() const;
  /// Those that have written an output, and are still connected: Connection::who() of the first few, with
  /// commas.
  std::string writers() const;

  /// Continues with clients that another server released, if they may connect and there is room.
  void take_over(std::vector<OpenConnection> clients, TimePoint now);
  /// A client that another process has let in, as if it had connected here.
  void admit(OpenConnection client, TimePoint now);
  /// Releases all clients without closing their connections, after an answer to those that wait.
  std::vector<OpenConnection> release();
  /// Answers those that wait, since the node ends.
  void end_waits();

  /// A client connects.
  void ready(TimePoint now) override;

  /// How long tick() need not be called; nullopt: not before something happens.
  std::optional<std::chrono::milliseconds> time_until_due(TimePoint now) const;
  /// Tells changes to those that wait for them, and closes what is overdue.
  void tick(TimePoint now);

 private:
  void open(OpenConnection client, TimePoint now);
  void sweep(TimePoint now);
  Connection& place_for(const IpAddress& newcomer);
  Connection& who_makes_room_for(const IpAddress& newcomer);
  bool accept_one(TimePoint now);
  void refuse(Descriptor socket, const sockaddr_storage& peer);
  void pause(int error);

  Loop& loop_;
  const Listener& listener_;
  Statistics& statistics_;
  Log& log_;
  Waiters waiters_;
  std::deque<Connection> connections_;  ///< never grows after the start: addresses are stable
  std::vector<Connection*> by_origin_;  ///< the same; sorted where it matters
  bool paused_ = false;                 ///< out of descriptors or memory
  bool pause_logged_ = false;           ///< and nobody was let in since
  bool in_use_ = false;                 ///< connections are open, or were at the last sweep
  TimePoint next_sweep_{};
};

}  // namespace coupler::device
