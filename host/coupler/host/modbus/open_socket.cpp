// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/open_socket.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/select.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "coupler/host/modbus/resolve.hpp"

namespace coupler::host {
namespace {

/// 0, or the errno of the failure.
int connect_to(int fd, const addrinfo& address, const Deadline& deadline, const Event& interrupt) {
  if (::connect(fd, address.ai_addr, address.ai_addrlen) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  std::array<pollfd, 2> wanted{{{fd, POLLOUT, 0}, {interrupt.fd(), POLLIN, 0}}};
  ::poll(wanted.data(), wanted.size(), deadline.left());
  if (interrupt.is_set()) return ECANCELED;
  if (wanted[0].revents == 0) return ETIMEDOUT;
  int error = 0;
  socklen_t size = sizeof error;
  ::getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size);
  return error;
}

Result<Descriptor> try_address(const addrinfo& address, const Deadline& deadline, const Event& interrupt,
                               const std::string& where) {
  Descriptor fd(::socket(address.ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, IPPROTO_TCP));
  // libmodbus waits with select(), which knows no descriptor above FD_SETSIZE.
  if (fd.get() >= FD_SETSIZE) return fail(NotConnected{fmt::format("{}: too many open files", where)});
  const int error = fd.get() < 0 ? errno : connect_to(fd.get(), address, deadline, interrupt);
  if (error != 0) return fail(NotConnected{fmt::format("{}: {}", where, std::strerror(error))});
  const int on = 1;
  ::setsockopt(fd.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return fd;
}

}  // namespace

Result<Descriptor> open_socket(const std::string& host, std::uint16_t port, std::chrono::milliseconds timeout,
                               const Event& interrupt) {
  const Deadline deadline(timeout);
  const auto addresses = resolve(host, port, deadline, interrupt);
  if (!addresses) return tl::make_unexpected(addresses.error());
  const std::string where = fmt::format("{} port {}", host, port);
  Result<Descriptor> result = fail(NotConnected{where + ": no address"});
  for (const addrinfo* address = addresses->get(); address != nullptr && !result; address = address->ai_next)
    result = try_address(*address, deadline, interrupt, where);
  return result;
}

}  // namespace coupler::host
