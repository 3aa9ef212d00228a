// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/tls/tls_server.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "coupler/base/starts_with.hpp"
#include "coupler/device/net/client_address.hpp"
#include "coupler/device/net/client_socket.hpp"
#include "coupler/map/nearest.hpp"
#include "coupler/tls/alert.hpp"

namespace coupler::device {
namespace {

constexpr int accepts_per_turn = 16;
constexpr std::chrono::milliseconds pause_without_room{250};

bool is_outside(const TlsConnection& one) {
  return one.state() == TlsConnection::State::handshake || one.state() == TlsConnection::State::draining;
}

bool lists(const std::vector<std::string>& roles, const std::optional<std::string>& role) {
  return role && std::find(roles.begin(), roles.end(), *role) != roles.end();
}

}  // namespace

TlsServer::TlsServer(Loop& loop, Log& log, HandOver hand_over)
    : loop_(loop), log_(log), hand_over_(std::move(hand_over)) {}

TlsServer::~TlsServer() {
  if (listener_.socket.is_open()) loop_.forget(listener_.socket.get(), *this);
}

void TlsServer::put_in_force(Listener listener, TlsRules rules) {
  if (listener_.socket.is_open()) loop_.forget(listener_.socket.get(), *this);
  listener_ = std::move(listener);
  if (!loop_.watch(listener_.socket.get(), Interest::read, *this))
    log_.fail(fmt::format("cannot accept connections with TLS: {}", std::strerror(errno)));
  const std::vector<std::string> former = rules_ ? std::move(rules_->roles) : std::vector<std::string>();
  rules_ = std::move(rules);
  for (TlsConnection& connection : connections_) {
    // Whoever is in its handshake would end it by the former rules.
    if (connection.state() == TlsConnection::State::handshake) connection.close();
    if (connection.state() != TlsConnection::State::open) continue;
    if (const auto why = why_not_any_more(connection, former)) {
      log_.write(fmt::format("'{}' ({}) is disconnected: {}", connection.peer().name,
                             host_of(connection.address()), *why));
      connection.close();
    }
  }
  forget_ended();
}

std::optional<std::string> TlsServer::why_not_any_more(const TlsConnection& connection,
                                                       const std::vector<std::string>& former_roles) const {
  const auto& role = connection.peer().role;
  if (lists(former_roles, role) && !lists(rules_->roles, role))
    return fmt::format("there is no role '{}' any more", *role);
  if (!listener_.allowed.admits(connection.address())) return "'allow' does not list its address";
  return connection.why_refused(rules_->context);
}

void TlsServer::ready(TimePoint now) {
  for (int i = 0; i < accepts_per_turn; ++i)
    if (!accept_one(now)) return;
}

/// False: nobody waits, or nobody can be let in now.
bool TlsServer::accept_one(TimePoint now) {
  sockaddr_storage peer{};
  socklen_t size = sizeof peer;
  Descriptor socket(::accept4(listener_.socket.get(), reinterpret_cast<sockaddr*>(&peer), &size,
                              SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (!socket.is_open()) {
    if (errno != EMFILE && errno != ENFILE && errno != ENOBUFS && errno != ENOMEM) return false;
    log_.warn_limited("accept",
                      fmt::format("cannot accept connections with TLS: {}; trying again until it works",
                                  std::strerror(errno)));
    loop_.change(listener_.socket.get(), Interest::nothing, *this);
    accepts_again_ = now + pause_without_room;
    return false;
  }
  if (!listener_.allowed.admits(peer)) {
    log_.write_limited("allow",
                       fmt::format("{} may not connect: the map's 'allow' does not list it", host_of(peer)));
    return true;
  }
  configure_client(socket.get());
  notice_end_soon(socket.get());  // it may schedule outputs, which is seen by another process only
  make_room_for(origin_of(peer));
  if (connections_.size() < most_connections)
    connections_.emplace_back(loop_, *this, rules_->context, std::move(socket), peer, now);
  else
    log_.warn_limited("full", fmt::format("{} cannot be let in: there are {} connections with TLS",
                                          host_of(peer), connections_.size()));
  return true;
}

/// Makes room among the connections that are not let in, or are on their way out: a client that floods the
/// server displaces itself first.
void TlsServer::make_room_for(const IpAddress& newcomer) {
  std::size_t all = 0;
  std::size_t own = 0;
  for (const TlsConnection& one : connections_) {
    if (!is_outside(one)) continue;
    ++all;
    own += one.origin() == newcomer ? 1 : 0;
  }
  if (own >= most_handshakes_of_one)
    next_to_go(&newcomer)->close();
  else if (all >= most_handshakes)
    next_to_go(nullptr)->close();
  else
    return;
  forget_ended();
}

/// The one whose time is over next. `origin` may be null: of all.
TlsConnection* TlsServer::next_to_go(const IpAddress* origin) {
  TlsConnection* first = nullptr;
  for (TlsConnection& one : connections_)
    if (is_outside(one) && (origin == nullptr || one.origin() == *origin) &&
        (first == nullptr || one.deadline() < first->deadline()))
      first = &one;
  return first;
}

Descriptor TlsServer::admit(TlsConnection& connection) {
  const tls::Peer& peer = connection.peer();
  const std::string who = fmt::format("'{}' ({})", peer.name, host_of(connection.address()));
  std::array<int, 2> pair{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, pair.data()) != 0) {
    log_.warn_limited("admit", fmt::format("{} cannot be let in: {}", who, std::strerror(errno)));
    return {};
  }
  Descriptor own(pair[0]);
  OpenConnection client;
  client.socket = Descriptor(pair[1]);
  ::setsockopt(pair[1], SOL_SOCKET, SO_SNDBUF, &client_send_buffer, sizeof client_send_buffer);
  client.tls = TlsPeer{connection.address(), ShortText(peer.name), ShortText(peer.role.value_or(""))};
  if (!hand_over_(client)) {
    log_.warn_limited("admit",
                      fmt::format("{} cannot be let in: the process that answers does not take it", who));
    return {};
  }
  // Each name is a kind of its own, so that nobody hides behind somebody else's connections: only the
  // authority gives names.
  if (!peer.role)
    log_.write_limited("client " + peer.name,
                       fmt::format("{} connected by {}, without a role", who, connection.version()));
  else if (!lists(rules_->roles, peer.role))
    log_.warn_limited(
        "role of " + peer.name,
        fmt::format("{} connected by {} as '{}', which is no role of the map; {}", who, connection.version(),
                    *peer.role, suggestion(*peer.role, {rules_->roles.begin(), rules_->roles.end()})));
  else
    log_.write_limited("client " + peer.name,
                       fmt::format("{} connected by {} as {}", who, connection.version(), *peer.role));
  return own;
}

void TlsServer::failed(const TlsConnection& connection, const std::string& problem) {
  if (problem == tls::has_left) return;  // a port scan, or one that does not believe this node and said so
  // Each reason is a kind of its own: their beginnings are our own texts, and few.
  log_.warn_limited(
      "refused: " + problem.substr(0, 24),
      fmt::format("{} {}: {}{}", host_of(connection.address()),
                  starts_with(problem, tls::refuses) ? "did not connect" : "was refused", problem,
                  problem == tls::no_tls ? "; clients without TLS have the node's other port" : ""));
}

std::optional<std::chrono::milliseconds> TlsServer::time_until_due(TimePoint now) const {
  using std::chrono::milliseconds;
  TimePoint due = accepts_again_.value_or(TimePoint::max());
  for (const TlsConnection& one : connections_) due = std::min(due, one.deadline());
  if (due == TimePoint::max()) return std::nullopt;
  return std::max(milliseconds(0), std::chrono::ceil<milliseconds>(due - now));
}

void TlsServer::tick(TimePoint now) {
  for (TlsConnection& one : connections_)
    if (one.state() != TlsConnection::State::ended) one.tick(now);
  forget_ended();
  if (!accepts_again_ || now < *accepts_again_) return;
  accepts_again_.reset();
  loop_.change(listener_.socket.get(), Interest::read, *this);
}

void TlsServer::forget_ended() {
  connections_.remove_if([](const TlsConnection& one) { return one.state() == TlsConnection::State::ended; });
}

}  // namespace coupler::device
