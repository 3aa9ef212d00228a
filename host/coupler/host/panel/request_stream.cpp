// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/request_stream.hpp"

#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>

#include "coupler/base/descriptor.hpp"

namespace coupler::host {
namespace {

constexpr std::chrono::milliseconds slice{100};          ///< after which `ending` is looked at
constexpr std::chrono::seconds longest_write{30};        ///< of one that goes on
constexpr std::size_t largest = std::size_t{20} * 1024;  ///< bytes of a request, with its body

}  // namespace

RequestStream::RequestStream(socket_t socket, const std::atomic<bool>& ending)
    : socket_(socket), ending_(ending) {}

RequestStream::~RequestStream() {
  ::shutdown(socket_, SHUT_RDWR);
  ::close(socket_);
}

void RequestStream::gather() {
  std::array<char, 4096> piece{};
  while (wants_ != 0 && !has_request_) {
    const Progress got = receive(piece.data(), piece.size());
    wants_ = got.bytes > 0 ? POLLIN : got.wants;
    if (got.bytes <= 0) return;
    const std::size_t before = request_.size();
    request_.append(piece.data(), static_cast<std::size_t>(got.bytes));
    if (size_ == unknown_size) size_ = request_size(request_, before, largest_body);
    has_request_ = request_.size() >= std::min(size_, largest);
  }
}

ssize_t RequestStream::read(char* to, std::size_t size) {
  const std::size_t count = request_.copy(to, size, taken_);
  taken_ += count;
  return static_cast<ssize_t>(count);
}

RequestStream::Progress RequestStream::receive(char* to, std::size_t size) {
  const ssize_t got = ::recv(socket_, to, size, MSG_DONTWAIT);
  if (got >= 0) return {got, 0};
  return {0, would_block() ? short{POLLIN} : short{0}};
}

RequestStream::Progress RequestStream::give(const char* from, std::size_t size) {
  const ssize_t given = ::send(socket_, from, size, MSG_NOSIGNAL | MSG_DONTWAIT);
  if (given >= 0) return {given, 0};
  return {0, would_block() ? short{POLLOUT} : short{0}};
}

bool RequestStream::is_there() const {
  pollfd one{socket_, POLLRDHUP, 0};  // also behind bytes that nobody has read
  return ::poll(&one, 1, 0) == 0;
}

bool RequestStream::is_writable() const {
  return is_there() && wait(POLLOUT, std::chrono::steady_clock::now() + timeout);
}

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

ssize_t RequestStream::write(const char* from, std::size_t size) {
  const Time last = std::chrono::steady_clock::now() + longest_write;
  Time until = std::chrono::steady_clock::now() + timeout;
  for (std::size_t sent = 0; sent < size;) {
    if (ending_) return -1;
    const Progress given = give(from + sent, size - sent);
    if (given.bytes > 0) {
      sent += static_cast<std::size_t>(given.bytes);
      until = std::min(last, std::chrono::steady_clock::now() + timeout);
    } else if (given.wants == 0 || !wait(given.wants, until)) {
      return -1;
    }
  }
  return static_cast<ssize_t>(size);
}

void RequestStream::get_local_ip_and_port(std::string& ip, int& /*port*/) const {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  // sockaddr_storage is what the call of the sockets API fills with the address of any family.
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  std::array<char, NI_MAXHOST> text{};
  if (::getsockname(socket_, any, &size) != 0 ||
      ::getnameinfo(any, size, text.data(), text.size(), nullptr, 0, NI_NUMERICHOST) != 0)
    return;
  ip = text.data();
  ip.erase(std::min(ip.find('%'), ip.size()));  // the interface of a link-local address: no browser sends it
}

}  // namespace coupler::host
