// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/net/tcp_server.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <tuple>
#include <utility>

#include "coupler/device/net/client_address.hpp"
#include "coupler/device/net/client_socket.hpp"

namespace coupler::device {
namespace {

constexpr std::chrono::milliseconds sweep_period{250};
constexpr int accepts_per_turn = 16;      ///< a storm of connections leaves turns for the others
constexpr std::size_t other_files = 160;  ///< GPIO lines with edges, logs, libraries

std::size_t affordable(std::size_t wanted) {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return wanted;
  const std::size_t files = limit.rlim_cur;
  return std::clamp<std::size_t>(files > other_files ? files - other_files : 1, 1, wanted);
}

/// Returns whether an error of accept(2) concerns only this one client.
bool concerns_the_client(int error) {
  for (const int known : {EINTR, ECONNABORTED, EPROTO, EPERM, ENETDOWN, ENOPROTOOPT, EHOSTDOWN, ENONET,
                          EHOSTUNREACH, EOPNOTSUPP, ENETUNREACH})
    if (error == known) return true;
  return false;
}

}  // namespace

TcpServer::TcpServer(Loop& loop, const Listener& listener, Server& server, Statistics& statistics, Log& log,
                     std::size_t capacity)
    : loop_(loop),
      listener_(listener),
      statistics_(statistics),
      log_(log),
      waiters_(server, affordable(capacity)) {
  for (std::size_t i = affordable(capacity); i > 0; --i)
    connections_.emplace_back(loop, server, waiters_, statistics, log);
  for (Connection& connection : connections_) by_origin_.push_back(&connection);
  [[maybe_unused]] const bool watched = loop_.watch(listener_.socket.get(), Interest::read, *this);
  assert(watched);
}

TcpServer::~TcpServer() { loop_.forget(listener_.socket.get(), *this); }

std::size_t TcpServer::size() const {
  return static_cast<std::size_t>(
      std::count_if(connections_.begin(), connections_.end(), [](const auto& c) { return c.is_open(); }));
}

std::string TcpServer::writers() const {
  constexpr std::size_t most = 4;
  std::string text;
  std::size_t count = 0;
  for (const Connection& each : connections_) {
    if (!each.is_open() || !each.has_written()) continue;
    if (++count <= most) text += (count == 1 ? "" : ", ") + each.who();
  }
  return count <= most ? text : fmt::format("{}, and {} more", text, count - most);
}

void TcpServer::ready(TimePoint now) {
  for (int i = 0; i < accepts_per_turn; ++i)
    if (!accept_one(now)) return;
}

void TcpServer::take_over(std::vector<OpenConnection> clients, TimePoint now) {
  for (OpenConnection& client : clients)
    if (size() < capacity()) open(std::move(client), now);
}

void TcpServer::admit(OpenConnection client, TimePoint now) {
  ++statistics_.connections;
  open(std::move(client), now);
}

void TcpServer::open(OpenConnection client, TimePoint now) {
  const auto peer = client.tls ? std::optional(client.tls->address) : peer_of(client.socket.get());
  if (!peer) return;
  if (!listener_.allowed.admits(*peer)) return refuse(std::move(client.socket), *peer);
  in_use_ = true;
  const IpAddress origin = origin_of(*peer);
  place_for(origin).open(std::move(client), origin, now);
}

std::vector<OpenConnection> TcpServer::release() {
  std::vector<OpenConnection> clients;
  for (Connection& connection : connections_)
    if (connection.is_open()) clients.push_back(connection.release());
  return clients;
}

void TcpServer::end_waits() {
  for (Connection& connection : connections_)
    if (connection.is_open()) connection.end_wait();
}

/// False: nobody waits, or nobody can be let in now.
bool TcpServer::accept_one(TimePoint now) {
  sockaddr_storage peer{};
  socklen_t size = sizeof peer;
  Descriptor socket(::accept4(listener_.socket.get(), reinterpret_cast<sockaddr*>(&peer), &size,
                              SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (!socket.is_open()) {
    const int error = errno;
    if (concerns_the_client(error)) return true;
    if (error != EAGAIN && error != EWOULDBLOCK) pause(error);
    return false;
  }
  if (!listener_.allowed.admits(peer)) {
    refuse(std::move(socket), peer);
    return true;
  }
  configure_client(socket.get());
  ++statistics_.connections;
  in_use_ = true;
  pause_logged_ = false;
  const IpAddress origin = origin_of(peer);
  place_for(origin).open(std::move(socket), origin, now);
  return true;
}

/// Logged once: a client that tries again and again must not fill the log.
void TcpServer::refuse(Descriptor socket, const sockaddr_storage& peer) {
  if (statistics_.refusals++ == 0)
    log_.write(
        fmt::format("{} may not connect: the map's 'allow' does not list it; further refused connections are "
                    "only counted",
                    host_of(peer)));
  socket.close();
}

/// The listener stays readable while it cannot accept; watching it would spin.
void TcpServer::pause(int error) {
  if (!pause_logged_)
    log_.warn_limited("accept", fmt::format("cannot accept connections: {}; trying again until it works",
                                            std::strerror(error)));
  pause_logged_ = paused_ = true;
  loop_.change(listener_.socket.get(), Interest::nothing, *this);
}

Connection& TcpServer::place_for(const IpAddress& newcomer) {
  const auto free = std::find_if(connections_.begin(), connections_.end(),
                                 [](const Connection& connection) { return !connection.is_open(); });
  if (free != connections_.end()) return *free;
  Connection& chosen = who_makes_room_for(newcomer);
  ++statistics_.evictions;
  chosen.close();
  return chosen;
}

/// All places are taken. The origin with the most connections gives one up, the newcomer's being counted; so
/// nobody can push out who has fewer.
Connection& TcpServer::who_makes_room_for(const IpAddress& newcomer) {
  std::sort(by_origin_.begin(), by_origin_.end(),
            [](const Connection* a, const Connection* b) { return a->origin() < b->origin(); });
  const auto rank = [&](const Connection& one, std::ptrdiff_t of_its_origin) {
    const bool own = one.origin() == newcomer;
    return std::make_tuple(-(of_its_origin + own), !own, one.has_asked(), one.has_written(),
                           one.last_active());
  };
  Connection* chosen = by_origin_.front();
  auto first_rank = rank(*chosen, 0);
  for (auto begin = by_origin_.begin(); begin != by_origin_.end();) {
    const auto end = std::find_if(begin, by_origin_.end(),
                                  [&](const Connection* one) { return one->origin() != (*begin)->origin(); });
    const std::ptrdiff_t count = end - begin;
    for (; begin != end; ++begin) {
      const auto its = rank(**begin, count);
      if (its >= first_rank) continue;
      first_rank = its;
      chosen = *begin;
    }
  }
  return *chosen;
}

std::optional<std::chrono::milliseconds> TcpServer::time_until_due(TimePoint now) const {
  using std::chrono::milliseconds;
  if (const auto due = waiters_.due(); due && *due < now + sweep_period)
    return std::max(milliseconds(0), std::chrono::ceil<milliseconds>(*due - now));
  return in_use_ || paused_ ? std::optional(sweep_period) : std::nullopt;
}

void TcpServer::tick(TimePoint now) {
  waiters_.answer(now);
  if (now >= next_sweep_) sweep(now);
}

void TcpServer::sweep(TimePoint now) {
  next_sweep_ = now + sweep_period;
  for (Connection& connection : connections_) {
    if (!connection.deadline() || *connection.deadline() > now) continue;
    ++statistics_.timeouts;
    connection.close();
  }
  in_use_ = size() > 0;
  if (!paused_) return;
  paused_ = false;
  loop_.change(listener_.socket.get(), Interest::read, *this);
}

}  // namespace coupler::device
