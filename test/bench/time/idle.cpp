// SPDX-License-Identifier: Apache-2.0
// The floor of a client of many idle nodes: asks each for changes, a second at a time, and looks at nothing.
//   coupler_bench_idle PORT…
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <vector>

#include "test/bench/node/lock_step_client.hpp"

namespace coupler::bench {
namespace {

/// docs/time.md, function code 65; the frame's header is 7 bytes.
using Request = std::array<std::uint8_t, 7 + 16>;
constexpr std::size_t reply_size = 7 + 35;
constexpr std::size_t epoch = 2;
constexpr std::size_t newest = 22;

class Waiting {
 public:
  explicit Waiting(std::uint16_t port) : client_(port) { ask(); }

  int socket() const { return client_.socket(); }
  void ask_again() {
    std::array<std::uint8_t, reply_size> reply;
    if (::recv(socket(), reply.data(), reply.size(), MSG_WAITALL) != static_cast<ssize_t>(reply.size()))
      give_up("a node ended, or told of a change");
    std::copy_n(&reply[7 + epoch], 4, &request_[7 + 4]);
    std::copy_n(&reply[7 + newest], 8, &request_[7 + 8]);
    ask();
  }

 private:
  void ask() {
    if (::send(socket(), request_.data(), request_.size(), MSG_NOSIGNAL) !=
        static_cast<ssize_t>(request_.size()))
      give_up("cannot send a request");
  }

  LockStepClient client_;
  Request request_{0, 0, 0, 0, 0, 17, 255, 65, 1, 1000 >> 8, 1000 & 0xFF};
};

}  // namespace
}  // namespace coupler::bench

int main(int argc, char** argv) {
  using coupler::bench::Waiting;
  std::deque<Waiting> nodes;
  std::vector<pollfd> sockets;
  for (int i = 1; i < argc; ++i) {
    nodes.emplace_back(static_cast<std::uint16_t>(std::atoi(argv[i])));
    sockets.push_back({nodes.back().socket(), POLLIN, 0});
  }
  std::fprintf(stderr, "waiting\n");
  while (::poll(sockets.data(), sockets.size(), -1) > 0)
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (sockets[i].revents != 0) nodes[i].ask_again();
  return 1;
}
