// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/resolve.hpp"

#include <poll.h>

#include <array>
#include <thread>

#include <fmt/format.h>

namespace coupler::host {
namespace {

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

tl::unexpected<Error> unknown_host(const std::string& host, const char* why) {
  return fail(NotConnected{fmt::format("unknown host '{}' ({}); check the map's address", host, why)});
}

}  // namespace

Result<Addresses> resolve(const std::string& host, std::uint16_t port, Deadline deadline,
                          const Event& interrupt) {
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
    if (!lookup->done.is_set()) return unknown_host(host, "no answer from the name server");
  }
  if (lookup->status != 0) return unknown_host(host, ::gai_strerror(lookup->status));
  return std::move(lookup->found);
}

}  // namespace coupler::host
