// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/request_stream.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

namespace coupler::host {
namespace {

constexpr std::chrono::milliseconds slice{100};    ///< after which `ending` is looked at
constexpr std::chrono::seconds longest_write{30};  ///< of one that goes on

using NameOf = int (*)(int, sockaddr*, socklen_t*);

void address_of(NameOf name_of, socket_t socket, std::string& ip, int& port) {
  sockaddr_storage address{};
  socklen_t length = sizeof address;
  // sockaddr_storage is what the call of the sockets API fills with the address of any family.
  if (name_of(socket, reinterpret_cast<sockaddr*>(&address), &length) != 0) return;
  std::array<char, INET6_ADDRSTRLEN> text{};
  const void* bytes = nullptr;
  sockaddr_in v4{};
  sockaddr_in6 v6{};
  if (address.ss_family == AF_INET) {
    std::memcpy(&v4, &address, sizeof v4);
    bytes = &v4.sin_addr;
    port = ntohs(v4.sin_port);
  } else {
    std::memcpy(&v6, &address, sizeof v6);
    bytes = &v6.sin6_addr;
    port = ntohs(v6.sin6_port);
  }
  if (::inet_ntop(address.ss_family, bytes, text.data(), text.size()) != nullptr) ip = text.data();
}

}  // namespace

RequestStream::RequestStream(socket_t socket, const std::atomic<bool>& ending)
    : socket_(socket), ending_(ending) {}

bool RequestStream::wait(short events, Time until) const {
  pollfd one{socket_, events, 0};
  while (!ending_) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
    if (left.count() <= 0) return false;
    const int ready = ::poll(&one, 1, static_cast<int>(std::min(left, slice).count()));
    if (ready > 0) return (one.revents & events) != 0;
    if (ready < 0 && errno != EINTR) return false;
  }
  return false;
}

bool RequestStream::is_there() const {
  pollfd one{socket_, POLLRDHUP, 0};  // also behind bytes that nobody has read
  return ::poll(&one, 1, 0) == 0;
}

bool RequestStream::is_writable() const {
  return is_there() && wait(POLLOUT, std::chrono::steady_clock::now() + timeout);
}

ssize_t RequestStream::receive(char* to, std::size_t size, Time until) {
  return wait(POLLIN, until) ? ::recv(socket_, to, size, 0) : -1;
}

ssize_t RequestStream::give(const char* from, std::size_t size, Time until) {
  for (;;) {
    if (!wait(POLLOUT, until)) return -1;
    const ssize_t given = ::send(socket_, from, size, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (given >= 0 || (errno != EAGAIN && errno != EINTR)) return given;
  }
}

ssize_t RequestStream::read(char* to, std::size_t size) {
  if (begin_ == end_) {
    if (received_ >= largest || std::chrono::steady_clock::now() > until_) return -1;
    const ssize_t got = receive(buffer_.data(), buffer_.size(), until_);
    if (got <= 0) return got;
    begin_ = 0;
    end_ = static_cast<std::size_t>(got);
    received_ += end_;
  }
  const std::size_t taken = std::min(size, end_ - begin_);
  std::copy_n(buffer_.data() + begin_, taken, to);
  begin_ += taken;
  return static_cast<ssize_t>(taken);
}

ssize_t RequestStream::write(const char* from, std::size_t size) {
  const Time last = std::chrono::steady_clock::now() + longest_write;
  std::size_t sent = 0;
  while (sent < size) {
    const ssize_t given =
        give(from + sent, size - sent, std::min(last, std::chrono::steady_clock::now() + timeout));
    if (given <= 0) return -1;
    sent += static_cast<std::size_t>(given);
  }
  return static_cast<ssize_t>(sent);
}

void RequestStream::get_remote_ip_and_port(std::string& ip, int& port) const {
  address_of(::getpeername, socket_, ip, port);
}

void RequestStream::get_local_ip_and_port(std::string& ip, int& port) const {
  address_of(::getsockname, socket_, ip, port);
}

}  // namespace coupler::host
