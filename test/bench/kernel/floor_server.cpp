// SPDX-License-Identifier: Apache-2.0
// The least that a program can do between a Modbus client and two lines: a blocking socket and one ioctl for
// each request. FC 2 and FC 5 of one bit, no other; nothing is checked, one connection at a time.
#include <arpa/inet.h>
#include <linux/gpio.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "test/bench/kernel/line.hpp"
#include "test/bench/node/lock_step_client.hpp"

namespace coupler::bench {
namespace {

using Request = std::array<std::uint8_t, 12>;

int listen_on(std::uint16_t port) {
  const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(listener, 8) != 0)
    give_up("cannot listen");
  return listener;
}

/// Turns the request into its reply; returns the reply's size.
std::size_t answer(Request& request, const Line& input, const Line& output) {
  constexpr std::uint8_t write_single_coil = 5;
  if (request[7] == write_single_coil) {
    output.drive(request[10] != 0);
    return request.size();
  }
  request[5] = 4;
  request[8] = 1;
  request[9] = input.read() ? 1 : 0;
  return 10;
}

void serve(int socket, const Line& input, const Line& output) {
  const int on = 1;
  ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  for (Request request;
       ::recv(socket, request.data(), request.size(), MSG_WAITALL) == static_cast<ssize_t>(request.size());) {
    const std::size_t size = answer(request, input, output);
    if (::send(socket, request.data(), size, MSG_NOSIGNAL) != static_cast<ssize_t>(size)) break;
  }
  ::close(socket);
}

}  // namespace
}  // namespace coupler::bench

int main(int argc, char** argv) {
  using namespace coupler::bench;
  if (argc != 5) {
    std::fprintf(stderr, "usage: %s PORT CHIP INPUT OUTPUT\n  Example: %s 1503 /dev/gpiochip0 2 3\n", argv[0],
                 argv[0]);
    return 2;
  }
  const auto number = [&](int i) { return static_cast<unsigned>(std::strtoul(argv[i], nullptr, 10)); };
  const Line input(argv[2], number(3), GPIO_V2_LINE_FLAG_INPUT);
  const Line output(argv[2], number(4), GPIO_V2_LINE_FLAG_OUTPUT);
  const int listener = listen_on(static_cast<std::uint16_t>(number(1)));
  std::fprintf(stderr, "serving the floor\n");
  for (;;) serve(::accept(listener, nullptr, nullptr), input, output);
}
