// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/reload_requests.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <optional>
#include <utility>

#include "coupler/base/descriptor.hpp"
#include "coupler/device/node/map_reading.hpp"

namespace coupler::device {
namespace {

enum Status { taken = 0, refused = 1, failed = 3 };

constexpr std::chrono::seconds longest_wait = MapReading::timeout + std::chrono::seconds(15);

struct Name {
  sockaddr_un address{};
  socklen_t size = 0;
  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&address); }
};

/// In the kernel's own space for such names, which begin with a zero byte: no file is left behind.
Name name_of(pid_t requester) {
  Name name;
  name.address.sun_family = AF_UNIX;
  const std::string text = fmt::format("coupler-node-reload-{}", requester);
  std::copy(text.begin(), text.end(), &name.address.sun_path[1]);
  name.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + text.size());
  return name;
}

Descriptor open_socket() {
  return Descriptor(::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
}

struct Answer {
  bool taken;
  std::string text;
};

/// The next datagram, if it is of that process.
std::optional<Answer> receive(int socket, pid_t from) {
  std::array<char, 1024> text{};
  iovec part{text.data(), text.size()};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(ucred))> control{};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t size = ::recvmsg(socket, &message, 0);
  const cmsghdr* header = size > 0 ? CMSG_FIRSTHDR(&message) : nullptr;
  if (header == nullptr || header->cmsg_type != SCM_CREDENTIALS) return std::nullopt;
  ucred sender{};
  std::memcpy(&sender, CMSG_DATA(header), sizeof sender);
  if (sender.pid != from) return std::nullopt;
  return Answer{text[0] == '1', std::string(&text[1], static_cast<std::size_t>(size) - 1)};
}

std::optional<Answer> wait_for_answer(int socket, pid_t from) {
  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + longest_wait;
  for (auto now = Clock::now(); now < deadline; now = Clock::now()) {
    pollfd answer{socket, POLLIN, 0};
    ::poll(&answer, 1,
           static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(deadline - now).count()));
    if (auto got = receive(socket, from)) return got;
  }
  return std::nullopt;
}

/// SIGHUP ends most other programs.
bool is_another_program(pid_t pid) {
  std::string name;
  std::getline(std::ifstream(fmt::format("/proc/{}/comm", pid)), name);
  return !name.empty() && name != "coupler-node";
}

}  // namespace

void ReloadRequests::add(pid_t requester) {
  if (requester != 0) all_.push_back(requester);
}

void ReloadRequests::reply(bool taken, std::string_view text) {
  const std::vector<pid_t> requesters = std::exchange(all_, {});
  if (requesters.empty()) return;
  const std::string answer = (taken ? "1" : "0") + std::string(text);
  const Descriptor socket = open_socket();
  if (!socket.is_open()) return;
  for (const pid_t requester : requesters) {
    const Name name = name_of(requester);
    ::sendto(socket.get(), answer.data(), answer.size(), MSG_NOSIGNAL, name.get(), name.size);
  }
}

int ask_to_reload(pid_t node, StderrLog& log) {
  const auto fail = [&](const std::string& why) {
    log.fail(why);
    return failed;
  };
  if (is_another_program(node))
    return fail(
        fmt::format("process {} is not a coupler-node; 'systemctl show -P MainPID coupler-node' prints the "
                    "id of the service's process",
                    node));
  const Descriptor socket = open_socket();
  const Name name = name_of(::getpid());
  const int on = 1;
  if (!socket.is_open() || ::bind(socket.get(), name.get(), name.size) != 0 ||
      ::setsockopt(socket.get(), SOL_SOCKET, SO_PASSCRED, &on, sizeof on) != 0)
    return fail(fmt::format("cannot listen for the answer of the node: {}", std::strerror(errno)));
  if (::kill(node, SIGHUP) != 0)
    return fail(fmt::format("cannot send SIGHUP to process {}: {}", node, std::strerror(errno)));
  const auto answer = wait_for_answer(socket.get(), node);
  if (!answer)
    return fail(fmt::format("process {} did not answer within {} s; its log may say why", node,
                            longest_wait.count()));
  if (log.is_journal()) return answer->taken ? taken : refused;
  if (answer->taken)
    log.write(answer->text);
  else
    log.fail(answer->text);
  return answer->taken ? taken : refused;
}

}  // namespace coupler::device
