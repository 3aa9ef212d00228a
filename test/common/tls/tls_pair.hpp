// SPDX-License-Identifier: Apache-2.0
// A server and a client in one thread, with certificates of one authority.
#pragma once

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <memory>
#include <string>

#include "coupler/tls/context.hpp"
#include "coupler/tls/issue.hpp"
#include "coupler/tls/session.hpp"

namespace coupler::tls {

/// One authority for all tests.
inline const Pem& test_authority() {
  static const Pem authority = make_authority("test").value();
  return authority;
}

inline Credentials credentials_of(const Subject& subject, const Pem& authority = test_authority(),
                                  KeyKind kind = KeyKind::p256) {
  const Pem own = issue(subject, kind, authority).value();
  return {own.certificate, own.key, test_authority().certificate, {}};
}

inline Subject test_node() { return {"press", true, {"press", "10.0.0.7"}, {}}; }
inline Subject test_client(const std::string& role = "operator") { return {"cell1", false, {}, role}; }

class SocketPair {
 public:
  SocketPair() {
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends_.data()), 0);
  }
  SocketPair(const SocketPair&) = delete;
  SocketPair& operator=(const SocketPair&) = delete;
  ~SocketPair() {
    close(0);
    close(1);
  }
  int operator[](std::size_t end) const { return ends_[end]; }
  void close(std::size_t end) {
    if (ends_[end] >= 0) ::close(ends_[end]);
    ends_[end] = -1;
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

/// A text that has come, without waiting; "-": nothing; "": its end.
inline std::string received(int socket) {
  std::array<char, 4096> text{};
  const ssize_t size = ::recv(socket, text.data(), text.size(), MSG_DONTWAIT);
  return size < 0 ? "-" : std::string(text.data(), static_cast<std::size_t>(size));
}
inline void put(int socket, const std::string& text) {
  EXPECT_EQ(::send(socket, text.data(), text.size(), MSG_NOSIGNAL), static_cast<ssize_t>(text.size()));
}

struct TlsPair {
  TlsPair(const Credentials& servers, const Credentials& clients, Verification of_server = for_clients(),
          Verification of_client = for_server("press"))
      : server(Context::make(Side::server, servers).value(), wire[0], std::move(of_server)),
        client(Context::make(Side::client, clients).value(), wire[1], std::move(of_client)) {}

  static Verification for_clients() {
    Verification verification;
    verification.wants_role = true;
    return verification;
  }
  static Verification for_server(const std::string& name) {
    Verification verification;
    verification.server = name;
    return verification;
  }

  /// Both are open, or one has ended. What one says last reaches the other one.
  void shake_hands() {
    for (int i = 0; i < 20; ++i)
      for (Session* one : {&client, &server})
        if (one->state() == Session::State::handshake) one->shake_hands();
    server.carry(server_side[0]);
    client.carry(client_side[0]);
  }
  void pump() {
    for (int i = 0; i < 10; ++i)
      for (Session* one : {&client, &server})
        if (one->state() == Session::State::open) one->pump();
  }
  bool are_open() const {
    return server.state() == Session::State::open && client.state() == Session::State::open;
  }

  SocketPair wire;
  SocketPair server_side;
  SocketPair client_side;
  Session server;
  Session client;
};

}  // namespace coupler::tls
