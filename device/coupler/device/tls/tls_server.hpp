// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coupler/device/core/log.hpp"
#include "coupler/device/net/listener.hpp"
#include "coupler/device/tls/tls_connection.hpp"
#include "coupler/tls/context.hpp"

namespace coupler::device {

/// Whom a node with TLS lets in.
struct TlsRules {
  tls::Context context;
  std::vector<std::string> roles;
};

/// Accepts clients, has them prove who they are, and hands each that does to the process that answers it. Its
/// connections lead there until either side ends them.
class TlsServer final : public EventHandler, public TlsConnection::Observer {
 public:
  static constexpr std::size_t most_connections = 384;
  static constexpr std::size_t most_handshakes = 64;        ///< those that were refused and drain included
  static constexpr std::size_t most_handshakes_of_one = 8;  ///< address, as origin_of()

  /// Hands a client over; false: nobody takes it.
  using HandOver = std::function<bool(const OpenConnection& client)>;

  TlsServer(Loop& loop, Log& log, HandOver hand_over);
  TlsServer(const TlsServer&) = delete;
  TlsServer& operator=(const TlsServer&) = delete;
  ~TlsServer();

  /// From now on it listens there, with these rules. Clients that they would not let in are closed; the
  /// others stay, though their certificates may have expired.
  void put_in_force(Listener listener, TlsRules rules);

  /// A client connects.
  void ready(TimePoint now) override;
  /// How long tick() need not be called; nullopt: not before something happens.
  std::optional<std::chrono::milliseconds> time_until_due(TimePoint now) const;
  void tick(TimePoint now);

  /// That are open, or in their handshake.
  std::size_t size() const { return connections_.size(); }

  Descriptor admit(TlsConnection& connection) override;
  void failed(const TlsConnection& connection, const std::string& problem) override;

 private:
  bool accept_one(TimePoint now);
  void make_room_for(const IpAddress& newcomer);
  TlsConnection* next_to_go(const IpAddress* origin);
  std::optional<std::string> why_not_any_more(const TlsConnection& connection,
                                              const std::vector<std::string>& former_roles) const;
  void forget_ended();

  Loop& loop_;
  Log& log_;
  HandOver hand_over_;
  Listener listener_;
  std::optional<TlsRules> rules_;
  std::list<TlsConnection> connections_;
  std::optional<TimePoint> accepts_again_;  ///< it is out of descriptors or memory
};

}  // namespace coupler::device
