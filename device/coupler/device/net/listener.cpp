// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/net/listener.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

namespace coupler::device {
namespace {

constexpr int backlog = SOMAXCONN;

std::string listen_error(const std::string& address, std::uint16_t port, const char* option, int error) {
  const std::string where = fmt::format("{}port {}", address.empty() ? "" : address + " ", port);
  if (error == EADDRINUSE)
    return fmt::format(
        "cannot listen on {}: another program listens there (ss -ltnp names it); stop it or choose another "
        "port with {}",
        where, option);
  if (error == EACCES)
    return fmt::format(
        "cannot listen on {}: not permitted; ports below 1024 need CAP_NET_BIND_SERVICE, so give the program "
        "that (setcap cap_net_bind_service=ep) or choose another port, such as {} 1{:03}",
        where, option, port % 1000);
  if (error == EADDRNOTAVAIL)
    return fmt::format("cannot listen on {}: this machine does not have that address (ip address lists them)",
                       where);
  return fmt::format("cannot listen on {}: {}", where, std::strerror(error));
}

std::string name_of(int socket) {
  sockaddr_storage bound{};
  socklen_t size = sizeof bound;
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> port{};
  auto* address = reinterpret_cast<sockaddr*>(&bound);
  if (::getsockname(socket, address, &size) != 0 ||
      ::getnameinfo(address, size, host.data(), host.size(), port.data(), port.size(),
                    NI_NUMERICHOST | NI_NUMERICSERV) != 0)
    return "?";
  return fmt::format(bound.ss_family == AF_INET6 ? "[{}]:{}" : "{}:{}", host.data(), port.data());
}

/// Binds and listens; the error is an errno.
tl::expected<Descriptor, int> open(const addrinfo& info) {
  Descriptor socket(::socket(info.ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!socket.is_open()) return tl::unexpected(errno);
  const int on = 1;
  const int off = 0;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (info.ai_family == AF_INET6) ::setsockopt(socket.get(), IPPROTO_IPV6, IPV6_V6ONLY, &off, sizeof off);
  if (::bind(socket.get(), info.ai_addr, info.ai_addrlen) != 0 || ::listen(socket.get(), backlog) != 0)
    return tl::unexpected(errno);
  return socket;
}

}  // namespace

tl::expected<Listener, std::string> Listener::share() const {
  Descriptor other(::fcntl(socket.get(), F_DUPFD_CLOEXEC, 0));
  if (!other.is_open())
    return tl::unexpected(fmt::format("cannot keep listening on {}: {}", name, std::strerror(errno)));
  return Listener{std::move(other), name, {}};
}

tl::expected<Listener, std::string> listen_on(const std::string& address, std::uint16_t port,
                                              const char* option) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICHOST;
  addrinfo* found = nullptr;
  if (const int error = ::getaddrinfo(address.empty() ? nullptr : address.c_str(),
                                      std::to_string(port).c_str(), &hints, &found);
      error != 0)
    return tl::unexpected(fmt::format("cannot listen on '{}': {}; give an IP address of this machine",
                                      address, ::gai_strerror(error)));
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, ::freeaddrinfo);

  // An IPv6 socket on every interface takes IPv4 too; a kernel without IPv6 has only the other.
  int error = 0;
  for (const int family : {AF_INET6, AF_INET})
    for (const addrinfo* info = found; info != nullptr; info = info->ai_next) {
      if (info->ai_family != family) continue;
      auto socket = open(*info);
      if (socket) {
        std::string name = name_of(socket->get());
        return Listener{*std::move(socket), std::move(name), {}};
      }
      error = socket.error();
    }
  return tl::unexpected(listen_error(address, port, option, error));
}

}  // namespace coupler::device
