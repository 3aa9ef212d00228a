// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "coupler/device/core/server.hpp"
#include "coupler/device/net/allow_list.hpp"
#include "coupler/device/net/listener.hpp"
#include "coupler/device/net/tcp_server.hpp"
#include "test/device/core/fake_log.hpp"
#include "test/device/core/node_under_test.hpp"

namespace coupler::device {

/// An ADU of unit 1.
inline Pdu adu(std::uint16_t transaction, const Pdu& pdu) {
  Pdu bytes(modbus::mbap_size);
  modbus::put_header({transaction, 1, {}}, pdu.size(), bytes.data());
  bytes.insert(bytes.end(), pdu.begin(), pdu.end());
  return bytes;
}

/// Reads holding registers 0 and 1, and the reply while they are 0.
inline Pdu question(std::uint16_t transaction) { return adu(transaction, pdu(3, {0, 2})); }
inline Pdu answer_to(std::uint16_t transaction) { return adu(transaction, {3, 4, 0, 0, 0, 0}); }

/// Where a client is, as its socket tells it.
inline sockaddr_storage ipv4(const char* address) {
  sockaddr_storage peer{};
  peer.ss_family = AF_INET;
  EXPECT_EQ(::inet_pton(AF_INET, address, &reinterpret_cast<sockaddr_in&>(peer).sin_addr), 1);
  return peer;
}
inline sockaddr_storage ipv6(const char* address) {
  sockaddr_storage peer{};
  peer.ss_family = AF_INET6;
  EXPECT_EQ(::inet_pton(AF_INET6, address, &reinterpret_cast<sockaddr_in6&>(peer).sin6_addr), 1);
  return peer;
}

/// A client as rude as the test wants.
class Client {
 public:
  /// `host`: it comes from 127.0.0.`host`.
  explicit Client(const std::string& server, std::uint8_t host = 1)
      : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK - 1 + host);
    EXPECT_EQ(::bind(socket_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    address.sin_port = htons(static_cast<std::uint16_t>(std::stoi(server.substr(server.rfind(':') + 1))));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  }

  /// False: the socket takes no more now.
  bool send(const Pdu& bytes) {
    return ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT) ==
           static_cast<ssize_t>(bytes.size());
  }
  void finish_sending() { ::shutdown(socket_.get(), SHUT_WR); }
  void vanish() { socket_.close(); }

  /// What arrives next: the kernel may take its time. Nothing after a minute.
  Pdu awaited() {
    pollfd readable{socket_.get(), POLLIN, 0};
    (void)::poll(&readable, 1, 60000);
    return received();
  }
  /// What has arrived.
  Pdu received() {
    Pdu bytes(65536);
    const ssize_t size = ::recv(socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    bytes.resize(size < 0 ? 0 : static_cast<std::size_t>(size));
    return bytes;
  }
  bool is_closed() {
    std::uint8_t byte = 0;
    const ssize_t size = ::recv(socket_.get(), &byte, 1, MSG_DONTWAIT | MSG_PEEK);
    return size == 0 || (size < 0 && errno != EAGAIN);
  }

 private:
  Descriptor socket_;
};

/// A server on a free loopback port, run by the test step by step.
struct TcpUnderTest {
  explicit TcpUnderTest(std::size_t capacity = 8, AllowList allowed = {})
      : listener(listen(std::move(allowed))), tcp(loop, listener, server, node.statistics, log, capacity) {}

  static Listener listen(AllowList allowed) {
    auto listener = listen_on("127.0.0.1", 0);
    EXPECT_TRUE(listener.has_value());
    listener->allowed = std::move(allowed);
    return *std::move(listener);
  }

  /// Runs the loop until nothing happens for a while.
  void settle() {
    TimePoint last = TimePoint::clock::now();
    while (TimePoint::clock::now() - last < std::chrono::milliseconds(30)) {
      const std::uint32_t before = progress();
      loop.run_once(std::chrono::milliseconds(10));
      if (progress() != before) last = TimePoint::clock::now();
    }
  }

  /// A client that is connected and accepted.
  Client connect(std::uint8_t host = 1) {
    Client client(tcp.name(), host);
    settle();
    return client;
  }

  std::uint32_t progress() const {
    const Statistics& s = node.statistics;
    return s.requests + s.connections + s.bad_frames + s.foreign_units + s.refusals +
           static_cast<std::uint32_t>(tcp.size());
  }

  NodeUnderTest node{fakes::MapBuilder()
                         .many(Table::holding_registers, 0, 125)
                         .many(Table::coils, 0, 2000)
                         .many(Table::discrete_inputs, 0, 2000)
                         .text(std::string(1000, 'x'))
                         .build()};
  Server server{1, node.handler, node.statistics};
  FakeLog log;
  Loop loop;
  Listener listener;
  TcpServer tcp;
};

}  // namespace coupler::device
