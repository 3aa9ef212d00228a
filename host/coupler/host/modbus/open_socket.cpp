// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/open_socket.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "coupler/base/what_failed.hpp"

namespace coupler::host {
namespace {

using Addresses = std::unique_ptr<addrinfo, void (*)(addrinfo*)>;

struct Lookup {
  std::string host;
  std::string service;
  Event done;
  int status = 0;
  Addresses found{nullptr, ::freeaddrinfo};

  void run(int flags) {
    addrinfo hints{};
    hints.ai_family = AF_UNSPEC;
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = flags;
    addrinfo* list = nullptr;
    status = ::getaddrinfo(host.c_str(), service.c_str(), &hints, &list);
    found.reset(list);
  }
};

/// The addresses of a host name or of a numeric address. Asking a name server cannot be interrupted, so a
/// thread of its own does it; that thread is left behind when `interrupt` or the deadline comes first.
Result<Addresses> resolve(const std::string& host, std::uint16_t port, Deadline deadline,
                          const Event& interrupt) try {
  const auto lookup = std::make_shared<Lookup>();
  lookup->host = host;
  lookup->service = fmt::to_string(port);
  lookup->run(AI_NUMERICHOST | AI_NUMERICSERV);
  if (lookup->status == EAI_NONAME) {
    std::thread([lookup] {
      lookup->run(AI_NUMERICSERV);
      lookup->done.set();
    }).detach();
    std::array<pollfd, 2> wanted{{{lookup->done.fd(), POLLIN, 0}, {interrupt.fd(), POLLIN, 0}}};
    ::poll(wanted.data(), wanted.size(), deadline.left());
    if (interrupt.is_set()) return fail(NotConnected{"interrupted"});
    if (!lookup->done.is_set()) return fail(lookup_failure(host, std::nullopt));
  }
  if (lookup->status != 0) return fail(lookup_failure(host, lookup->status));
  return std::move(lookup->found);
} catch (const std::system_error& error) {  // no thread, or no file descriptor; the next attempt may have one
  return fail(NotConnected{what_failed(error), true});
}

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

tl::expected<Descriptor, std::string> try_address(const addrinfo& address, const Deadline& deadline,
                                                  const Event& interrupt) {
  Descriptor fd(::socket(address.ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, IPPROTO_TCP));
  const int error = fd.get() < 0 ? errno : connect_to(fd.get(), address, deadline, interrupt);
  if (error != 0) return tl::make_unexpected(std::strerror(error));
  const int on = 1;
  ::setsockopt(fd.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return fd;
}

std::string text_of(const addrinfo& address) {
  std::array<char, NI_MAXHOST> text{};
  ::getnameinfo(address.ai_addr, address.ai_addrlen, text.data(), text.size(), nullptr, 0, NI_NUMERICHOST);
  return text.data();
}

}  // namespace

NotConnected lookup_failure(const std::string& host, std::optional<int> status) {
  const char* why = status ? ::gai_strerror(*status) : "no answer from the name server";
  // Nobody has said that there is no such host.
  const bool is_open = !status || *status == EAI_AGAIN || *status == EAI_FAIL || *status == EAI_SYSTEM;
  return {is_open ? fmt::format("the name '{}' could not be looked up ({}); check this machine's network and "
                                "its name server, or give the IP address",
                                host, why)
                  : fmt::format("unknown host '{}' ({}); check the address", host, why),
          true};
}

Result<Descriptor> connect_to_one(const addrinfo* addresses, const std::string& where,
                                  const Deadline& deadline, const Event& interrupt) {
  int untried = 0;
  for (const addrinfo* address = addresses; address != nullptr; address = address->ai_next) ++untried;
  // In their own order: a name server may turn that of the addresses, and a text that has changed is news.
  std::set<std::string> reasons{};
  std::set<std::string> by_address{};
  for (const addrinfo* address = addresses; address != nullptr; address = address->ai_next) {
    const Deadline share(std::chrono::milliseconds(deadline.left() / untried--));
    auto connected = try_address(*address, share, interrupt);
    if (connected) return std::move(*connected);
    if (interrupt.is_set()) return fail(NotConnected{"interrupted"});
    reasons.insert(connected.error());
    by_address.insert(fmt::format("{}: {}", text_of(*address), connected.error()));
  }
  if (reasons.empty()) return fail(NotConnected{where + ": no address"});
  if (reasons == std::set<std::string>{std::strerror(ETIMEDOUT)})
    return fail(NotConnected{
        fmt::format("{}: nothing answers there (connection timed out); check the address, and that "
                    "the device is on; a firewall may drop what is sent to this port",
                    where),
        true});
  return fail(
      NotConnected{fmt::format("{}: {}", where, fmt::join(reasons.size() > 1 ? by_address : reasons, "; "))});
}

Result<Descriptor> open_socket(const std::string& host, std::uint16_t port, std::chrono::milliseconds timeout,
                               const Event& interrupt) {
  const Deadline deadline(timeout);
  const auto addresses = resolve(host, port, deadline, interrupt);
  if (!addresses) return tl::make_unexpected(addresses.error());
  return connect_to_one(addresses->get(), fmt::format("{} port {}", host, port), deadline, interrupt);
}

bool is_readable(int fd) {
  pollfd wanted{fd, POLLIN, 0};
  return ::poll(&wanted, 1, 0) > 0;
}

}  // namespace coupler::host
