// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <modbus/modbus.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <functional>
#include <memory>
#include <thread>

#include <arpa/inet.h>

#include "coupler/host/core/wakeup.hpp"

namespace coupler::host::test {

/// A socket on a loopback port that the kernel gave it, which it keeps to itself.
class LoopbackSocket {
 public:
  LoopbackSocket() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (::bind(socket_.get(), reinterpret_cast<sockaddr*>(&address), size) != 0) std::abort();
    ::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
  }
  /// Until then who connects is refused.
  void listen(int backlog) const {
    if (::listen(socket_.get(), backlog) != 0) std::abort();
  }
  int fd() const { return socket_.get(); }
  std::uint16_t port() const { return port_; }

 private:
  Descriptor socket_;
  std::uint16_t port_ = 0;
};

/// A socket that listens, and what a thread does with each connection to it.
class LoopbackServer {
 public:
  /// `serve` gets the connection's descriptor and is called again until it returns false.
  explicit LoopbackServer(std::function<bool(int)> serve) : serve_(std::move(serve)) {
    listener_.listen(4);
    thread_ = std::thread([this] { run(); });
  }
  ~LoopbackServer() {
    stop_.set();
    thread_.join();
  }
  std::uint16_t port() const { return listener_.port(); }

 private:
  bool readable(int fd) const {
    std::array<pollfd, 2> wanted{{{fd, POLLIN, 0}, {stop_.fd(), POLLIN, 0}}};
    ::poll(wanted.data(), wanted.size(), -1);
    return wanted[1].revents == 0;
  }
  void run() {
    while (readable(listener_.fd())) {
      const Descriptor connection(::accept(listener_.fd(), nullptr, nullptr));
      while (readable(connection.get()) && serve_(connection.get())) {
      }
    }
  }

  std::function<bool(int)> serve_;
  LoopbackSocket listener_;
  Event stop_;
  std::thread thread_;
};

/// libmodbus's own server with 100 elements in each table.
class ModbusServer {
 public:
  ModbusServer() : server_([this](int fd) { return answer(fd); }) {}

  std::uint16_t port() const { return server_.port(); }
  /// Safe before a request and after its reply: the reply orders the accesses.
  modbus_mapping_t& tables() { return *tables_; }
  /// Ends the connection after so many requests, again and again; 0: never.
  std::atomic<int> hang_up_after{0};
  std::atomic<int> requests{0};  ///< so many have come
  /// Called before a write is answered, with its address. To be set before the first connection.
  std::function<void(int address)> on_write;

 private:
  bool answer(int fd) {
    std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH> query{};
    modbus_set_socket(context_.get(), fd);
    const int size = modbus_receive(context_.get(), query.data());
    if (size < 0) return false;
    ++requests;
    if (hang_up_after > 0 && requests % hang_up_after == 0) return false;
    if (size > 9 && on_write && (query[7] == 5 || query[7] == 6 || query[7] == 15 || query[7] == 16))
      on_write(query[8] * 256 + query[9]);
    return size == 0 || modbus_reply(context_.get(), query.data(), size, tables_.get()) >= 0;
  }

  std::unique_ptr<modbus_t, void (*)(modbus_t*)> context_{modbus_new_tcp("127.0.0.1", 0), modbus_free};
  std::unique_ptr<modbus_mapping_t, void (*)(modbus_mapping_t*)> tables_{
      modbus_mapping_new(100, 100, 100, 100), modbus_mapping_free};
  LoopbackServer server_;  // last: its thread uses the others
};

}  // namespace coupler::host::test
