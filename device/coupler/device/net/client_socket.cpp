// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/net/client_socket.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>

namespace coupler::device {

void configure_client(int socket) {
  const int on = 1;
  ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  ::setsockopt(socket, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
  ::setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &client_send_buffer, sizeof client_send_buffer);
}

void notice_end_soon(int socket) {
  const auto set = [socket](int option, int value) {
    ::setsockopt(socket, IPPROTO_TCP, option, &value, sizeof value);
  };
  set(TCP_KEEPIDLE, 2);   // s
  set(TCP_KEEPINTVL, 1);  // s
  set(TCP_KEEPCNT, 3);
  set(TCP_USER_TIMEOUT, 5000);  // ms, of what was sent
}

std::optional<sockaddr_storage> peer_of(int socket) {
  sockaddr_storage peer{};
  socklen_t size = sizeof peer;
  if (::getpeername(socket, reinterpret_cast<sockaddr*>(&peer), &size) != 0) return std::nullopt;
  return peer;
}

}  // namespace coupler::device
