// SPDX-License-Identifier: Apache-2.0
// What the node is measured against: a server as libmodbus's own bandwidth example has it. select() says who
// has sent something; modbus_receive() and modbus_reply() do the rest, one request a turn.
#include <arpa/inet.h>
#include <modbus/modbus.h>
#include <netinet/in.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace {

constexpr int coils = 33;
constexpr int holding_registers = 10;
constexpr int backlog = 256;

[[noreturn]] void give_up(const char* what) {
  std::fprintf(stderr, "floor: %s: %s\n", what, modbus_strerror(errno));
  std::exit(3);
}

int port_of(int listener) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  if (::getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size) != 0)
    give_up("cannot tell the port");
  return ntohs(address.sin_port);
}

/// The sockets that select() watches.
class Sockets {
 public:
  explicit Sockets(int listener) : highest_(listener) {
    FD_ZERO(&all_);
    FD_SET(listener, &all_);
  }

  void add(int socket) {
    FD_SET(socket, &all_);
    highest_ = std::max(highest_, socket);
  }
  void close(int socket) {
    ::close(socket);
    FD_CLR(socket, &all_);
  }
  int highest() const { return highest_; }
  fd_set wait() const {
    fd_set ready = all_;
    if (::select(highest_ + 1, &ready, nullptr, nullptr, nullptr) < 0) give_up("select");
    return ready;
  }

 private:
  fd_set all_{};
  int highest_;
};

void accept_one(int listener, Sockets& sockets) {
  const int socket = ::accept(listener, nullptr, nullptr);
  if (socket >= FD_SETSIZE)
    ::close(socket);
  else if (socket >= 0)
    sockets.add(socket);
}

void serve_one(int socket, modbus_t* context, modbus_mapping_t* mapping, Sockets& sockets) {
  std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH> request;
  modbus_set_socket(context, socket);
  const int size = modbus_receive(context, request.data());
  if (size > 0)
    modbus_reply(context, request.data(), size, mapping);
  else if (size < 0)
    sockets.close(socket);
}

}  // namespace

int main() {
  modbus_t* const context = modbus_new_tcp("127.0.0.1", 0);
  modbus_mapping_t* const mapping = modbus_mapping_new(coils, 0, holding_registers, 0);
  if (context == nullptr || mapping == nullptr) give_up("out of memory");
  const int listener = modbus_tcp_listen(context, backlog);
  if (listener < 0) give_up("cannot listen");
  std::fprintf(stderr, "serving the floor on 127.0.0.1:%d\n", port_of(listener));

  Sockets sockets(listener);
  for (;;) {
    const fd_set ready = sockets.wait();
    const int highest = sockets.highest();
    for (int socket = 0; socket <= highest; ++socket) {
      if (!FD_ISSET(socket, &ready)) continue;
      if (socket == listener)
        accept_one(listener, sockets);
      else
        serve_one(socket, context, mapping, sockets);
    }
  }
}
