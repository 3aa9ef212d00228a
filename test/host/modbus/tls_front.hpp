// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cstdlib>
#include <string>
#include <thread>
#include <utility>

#include <arpa/inet.h>

#include "test/common/tls/tls_pair.hpp"
#include "test/host/modbus/modbus_server.hpp"

namespace coupler::host::test {

/// TLS before a server without it, one connection after the other.
class TlsFront {
 public:
  TlsFront(std::uint16_t behind, const Credentials& credentials)
      : behind_(behind), context_(tls::Context::make(tls::Side::server, credentials).value()) {
    listener_.listen(4);
    thread_ = std::thread([this] { run(); });
  }
  TlsFront(const TlsFront&) = delete;
  TlsFront& operator=(const TlsFront&) = delete;
  ~TlsFront() {
    stop_.set();
    thread_.join();
  }
  std::uint16_t port() const { return listener_.port(); }
  /// Ends the connection that there is, with or without a word.
  void hang_up() { hangs_up_.set(); }
  /// Sends a message of TLS itself over the connection that there is.
  void update_key() { updates_key_.call(); }

 private:
  void run() {
    for (;;) {
      std::array<pollfd, 2> wanted{{{listener_.fd(), POLLIN, 0}, {stop_.fd(), POLLIN, 0}}};
      ::poll(wanted.data(), wanted.size(), -1);
      if (wanted[1].revents != 0) return;
      serve(Descriptor(::accept4(listener_.fd(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC)));
    }
  }

  void serve(const Descriptor& socket) {
    const Descriptor plain = connect_behind();
    tls::Session session(context_, socket.get(), tls::TlsPair::for_clients());
    bool carries = false;
    while (session.state() != tls::Session::State::ended && !hangs_up_.is_set()) {
      if (session.state() == tls::Session::State::handshake) session.shake_hands();
      if (session.state() == tls::Session::State::open && !std::exchange(carries, true))
        session.carry(plain.get());
      if (session.state() == tls::Session::State::open) session.pump();
      const auto wants = session.wants();
      std::array<pollfd, 5> wanted{{{wants.socket != 0 ? socket.get() : -1, wants.socket, 0},
                                    {wants.plain != 0 ? plain.get() : -1, wants.plain, 0},
                                    {stop_.fd(), POLLIN, 0},
                                    {hangs_up_.fd(), POLLIN, 0},
                                    {updates_key_.fd(), POLLIN, 0}}};
      if (session.state() != tls::Session::State::ended) ::poll(wanted.data(), wanted.size(), -1);
      if (wanted[2].revents != 0) return;
      if (wanted[4].revents != 0) {
        updates_key_.clear();
        SSL_key_update(session.ssl(), SSL_KEY_UPDATE_NOT_REQUESTED);
        SSL_do_handshake(session.ssl());
      }
    }
    if (hangs_up_.is_set()) return;
    // What the client has sent meanwhile must not make the kernel throw away what it is to read.
    ::shutdown(socket.get(), SHUT_WR);
    pollfd rest{socket.get(), POLLIN, 0};
    std::array<char, 1024> nothing{};
    while (::poll(&rest, 1, 1000) > 0 && ::recv(socket.get(), nothing.data(), nothing.size(), 0) > 0) {
    }
  }

  Descriptor connect_behind() const {
    Descriptor plain(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(behind_);
    if (::connect(plain.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) std::abort();
    ::fcntl(plain.get(), F_SETFL, O_NONBLOCK);
    return plain;
  }

  std::uint16_t behind_;
  tls::Context context_;
  LoopbackSocket listener_;
  Event stop_;
  Event hangs_up_;
  Wakeup updates_key_;
  std::thread thread_;
};

}  // namespace coupler::host::test
