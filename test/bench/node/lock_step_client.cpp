// SPDX-License-Identifier: Apache-2.0
#include "lock_step_client.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace coupler::bench {
namespace {

constexpr int patience_ms = 5000;

}  // namespace

void give_up(const char* what) {
  std::fprintf(stderr, "load: %s%s%s\n", what, errno != 0 ? ": " : "",
               errno != 0 ? std::strerror(errno) : "");
  std::exit(1);
}

LockStepClient::LockStepClient(std::uint16_t port)
    : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in server{};
  server.sin_family = AF_INET;
  server.sin_port = htons(port);
  server.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int on = 1;
  if (socket_ < 0 || ::connect(socket_, reinterpret_cast<sockaddr*>(&server), sizeof server) != 0 ||
      ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on) != 0)
    give_up("cannot connect");
}

LockStepClient::~LockStepClient() { ::close(socket_); }

void LockStepClient::ask(const Exchange& exchange) {
  exchange_ = &exchange;
  ++transaction_;
  size_ = 0;
  std::array<std::uint8_t, max_size> request;
  std::copy(exchange.request.begin(), exchange.request.end(), request.begin());
  request[0] = static_cast<std::uint8_t>(transaction_ >> 8);
  request[1] = static_cast<std::uint8_t>(transaction_);
  asked_ = Clock::now();
  if (::send(socket_, request.data(), exchange.request.size(), MSG_NOSIGNAL) !=
      static_cast<ssize_t>(exchange.request.size()))
    give_up("cannot send a request");
}

std::optional<LockStepClient::Clock::duration> LockStepClient::take() {
  const ssize_t more = ::recv(socket_, &received_[size_], received_.size() - size_, MSG_DONTWAIT);
  if (more < 0 && errno == EAGAIN) return std::nullopt;
  if (more < 0) give_up("cannot receive");
  errno = 0;
  if (more == 0) give_up("the server closed a connection that waits for a reply");
  size_ += static_cast<std::size_t>(more);
  const Adu& right = exchange_->reply;
  if (size_ < right.size()) return std::nullopt;
  const auto needed = Clock::now() - asked_;
  const int echoed = received_[0] << 8 | received_[1];
  if (size_ != right.size() || echoed != transaction_ ||
      !std::equal(right.begin() + 2, right.end(), received_.begin() + 2))
    give_up("a reply is wrong");
  return needed;
}

void LockStepClient::ask_and_wait(const Exchange& exchange) {
  ask(exchange);
  pollfd waiting{socket_, POLLIN, 0};
  do {
    errno = 0;
    if (::poll(&waiting, 1, patience_ms) != 1) give_up("no reply in 5 s");
  } while (!take());
}

bool LockStepClient::was_closed() const {
  std::uint8_t byte = 0;
  return ::recv(socket_, &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0 || (errno != EAGAIN && errno != 0);
}

}  // namespace coupler::bench
