// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "coupler/device/net/loop.hpp"
#include "coupler/device/net/open_connection.hpp"
#include "coupler/map/network.hpp"
#include "coupler/tls/context.hpp"
#include "coupler/tls/session.hpp"

namespace coupler::device {

/// One client of a TlsServer, from accept(2) to its end: its handshake, then its bytes to and from the
/// process that answers them, and after the last of them a moment in which the client can read why it ended.
class TlsConnection final : public EventHandler {
 public:
  static constexpr std::chrono::seconds handshake_timeout{5};
  static constexpr std::chrono::seconds write_timeout{5};  ///< for a client that takes nothing
  static constexpr std::chrono::seconds drain_timeout{1};

  /// Whom it tells.
  class Observer {
   public:
    /// Its handshake is over. The other end of its plain socket for whoever answers it; closed: nobody does.
    virtual Descriptor admit(TlsConnection& connection) = 0;
    /// It has failed, and why.
    virtual void failed(const TlsConnection& connection, const std::string& problem) = 0;

   protected:
    ~Observer() = default;
  };

  /// A connected, non-blocking socket of a client from there. The context and what is referred to outlive it.
  TlsConnection(Loop& loop, Observer& observer, const tls::Context& context, Descriptor socket,
                const sockaddr_storage& address, TimePoint now);
  TlsConnection(const TlsConnection&) = delete;
  TlsConnection& operator=(const TlsConnection&) = delete;
  ~TlsConnection();

  enum class State { handshake, open, draining, ended };
  State state() const { return state_; }
  const IpAddress& origin() const { return origin_; }
  const sockaddr_storage& address() const { return address_; }
  const tls::Peer& peer() const { return session_.verification().peer; }
  const char* version() const { return session_.version(); }
  /// Why its certificate, which was believed, is not any more; nullopt: it is.
  std::optional<std::string> why_refused(const tls::Context& context) const {
    return session_.why_refused_by(context);
  }

  void ready(TimePoint now) override;
  /// Ends it if its time is over.
  void tick(TimePoint now);
  /// When tick() has something to do; TimePoint::max(): nothing.
  TimePoint deadline() const { return deadline_; }
  /// Closes both sides.
  void close();

 private:
  /// The handler of one of its descriptors. A descriptor is not watched while nothing is wanted of it, since
  /// its end would be reported again and again.
  struct Watched {
    int fd = -1;
    std::uint32_t events = 0;
  };

  void go_on(TimePoint now);
  void open(TimePoint now);
  void end(TimePoint now);
  void drain();
  void watch(Watched& watched, short wanted);
  void watch_all(TimePoint now);

  Loop& loop_;
  Observer& observer_;
  Descriptor socket_;
  Descriptor plain_;
  sockaddr_storage address_;
  IpAddress origin_;
  TimePoint deadline_;
  bool waits_for_client_ = false;  ///< to read
  std::uint64_t sent_ = 0;         ///< when that was looked at
  tls::Session session_;
  Watched socket_events_;
  Watched plain_events_;
  bool is_unwatched_ = false;  ///< one of them, against its will
  State state_ = State::handshake;
};

}  // namespace coupler::device
