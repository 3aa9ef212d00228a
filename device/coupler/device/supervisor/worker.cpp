// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/supervisor/worker.hpp"

#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>
#include <utility>
#include <variant>

#include "coupler/device/net/signals.hpp"

namespace coupler::device {
namespace {

// The messages between both processes.
struct Beat {};
struct MakeRoom {};
struct Ended {};    ///< the other process has ended
struct Nothing {};  ///< for now
using Message = std::variant<Beat, MakeRoom, OpenConnection, Ended, Nothing>;

struct Pair {
  Descriptor one;
  Descriptor other;
};

enum class Kind : std::uint8_t { beat, make_room, client };

/// The beginning of each message; what of a client is unread and unsent follows.
struct Head {
  Kind kind;
  bool has_written = false;
  std::uint16_t unread = 0;
  std::uint16_t unsent = 0;
};

constexpr std::size_t longest_body = 4096;

/// Without waiting: a message that the socket does not take is lost.
void send(int socket, Kind kind) {
  const Head head{kind};
  (void)::send(socket, &head, sizeof head, MSG_DONTWAIT | MSG_NOSIGNAL);
}

/// Memory for one descriptor beside a message.
union Control {
  cmsghdr alignment;
  std::array<char, CMSG_SPACE(sizeof(int))> bytes;
};

template <std::size_t N>
msghdr message_of(std::array<iovec, N>& parts, Control& control) {
  msghdr message{};
  message.msg_iov = parts.data();
  message.msg_iovlen = parts.size();
  message.msg_control = control.bytes.data();
  message.msg_controllen = sizeof control.bytes;
  return message;
}

Descriptor descriptor_of(msghdr& message) {
  const cmsghdr* control = CMSG_FIRSTHDR(&message);
  if (control == nullptr || control->cmsg_type != SCM_RIGHTS) return {};
  int fd = -1;
  std::memcpy(&fd, CMSG_DATA(control), sizeof fd);
  return Descriptor(fd);
}

std::optional<Pair> open_pair() {
  std::array<int, 2> pair{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, pair.data()) != 0) return std::nullopt;
  return Pair{Descriptor(pair[0]), Descriptor(pair[1])};
}

/// Waits until the socket takes it. Both processes have the connection then.
void send_client(int socket, const OpenConnection& client) {
  assert(client.unread.size() + client.unsent.size() <= longest_body);
  Head head{Kind::client, client.has_written, static_cast<std::uint16_t>(client.unread.size()),
            static_cast<std::uint16_t>(client.unsent.size())};
  // sendmsg() does not change what it sends.
  std::array<iovec, 3> parts{{{&head, sizeof head},
                              {const_cast<std::uint8_t*>(client.unread.data()), client.unread.size()},
                              {const_cast<std::uint8_t*>(client.unsent.data()), client.unsent.size()}}};
  Control control{};
  msghdr message = message_of(parts, control);
  cmsghdr* rights = CMSG_FIRSTHDR(&message);
  rights->cmsg_level = SOL_SOCKET;
  rights->cmsg_type = SCM_RIGHTS;
  rights->cmsg_len = CMSG_LEN(sizeof(int));
  const int fd = client.socket.get();
  std::memcpy(CMSG_DATA(rights), &fd, sizeof fd);
  while (::sendmsg(socket, &message, MSG_NOSIGNAL) < 0 && errno == EINTR) {
  }
}

/// Without waiting.
Message receive(int socket) {
  Head head{};
  std::array<std::uint8_t, longest_body> body{};
  std::array<iovec, 2> parts{{{&head, sizeof head}, {body.data(), body.size()}}};
  Control control{};
  msghdr message = message_of(parts, control);
  const ssize_t size = ::recvmsg(socket, &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
  // An error (the other process ended and left something unread) comes once; what it sent comes after that.
  if (size < 0) return Nothing{};
  if (size == 0) return Ended{};
  if (head.kind == Kind::beat) return Beat{};
  if (head.kind == Kind::make_room) return MakeRoom{};
  OpenConnection client{descriptor_of(message), head.has_written};
  client.unread.assign(body.begin(), body.begin() + head.unread);
  client.unsent.assign(body.begin() + head.unread, body.begin() + head.unread + head.unsent);
  return client;
}

/// The life of the child. Its end of the channel is closed by the kernel, when its exit status is settled.
[[noreturn]] void live(const Worker::Work& work, Descriptor channel, pid_t parent) {
  ::prctl(PR_SET_NAME, "coupler-node-io");
  // At a terminal it stays in the supervisor's group: another one could not read what somebody types.
  if (!has_terminal()) ::setpgid(0, 0);
  if (!end_with_parent(parent, SIGTERM)) ::_exit(0);
  SupervisorLink supervisor(std::move(channel));
  ::_exit(work(supervisor));
}

}  // namespace

void SupervisorLink::watch(Loop& loop) {
  loop_ = &loop;
  [[maybe_unused]] const bool watched = loop.watch(channel_.get(), Interest::read, *this);
  assert(watched);
}

void SupervisorLink::beat() { send(channel_.get(), Kind::beat); }

void SupervisorLink::give(const OpenConnection& client) { send_client(channel_.get(), client); }

bool SupervisorLink::is_silent(TimePoint now) {
  silence_.sample(now, std::exchange(heard_, false), std::chrono::nanoseconds(0));
  return silence_.lasted() >= timeout;
}

void SupervisorLink::ready(TimePoint) {
  const Message message = receive(channel_.get());
  heard_ |= std::holds_alternative<Beat>(message);
  if (std::holds_alternative<MakeRoom>(message)) wants_room_ = true;
  // The kernel sends SIGTERM when the supervisor dies.
  if (std::holds_alternative<Ended>(message)) loop_->change(channel_.get(), Interest::nothing, *this);
}

tl::expected<std::unique_ptr<Worker>, int> Worker::start(Loop& loop, const Work& work,
                                                         std::function<void()> on_beat) {
  auto pair = open_pair();
  if (!pair) return tl::unexpected(errno);
  const pid_t parent = ::getpid();
  auto child = Child::start([&]() -> int {
    pair->one.close();
    live(work, std::move(pair->other), parent);
  });
  if (!child) return tl::unexpected(child.error());
  return std::unique_ptr<Worker>(
      new Worker(loop, *std::move(child), std::move(pair->one), std::move(on_beat)));
}

Worker::Worker(Loop& loop, Child child, Descriptor channel, std::function<void()> on_beat)
    : loop_(loop),
      child_(std::move(child)),
      channel_(std::move(channel)),
      on_beat_(std::move(on_beat)),
      last_beat_(TimePoint::clock::now()) {
  // Unwatched, it would seem silent.
  [[maybe_unused]] const bool watched = loop_.watch(channel_.get(), Interest::read, *this);
  assert(watched);
}

Worker::~Worker() { loop_.forget(channel_.get(), *this); }

void Worker::ready(TimePoint now) {
  Message message = receive(channel_.get());
  if (std::holds_alternative<Ended>(message)) {
    ended_ = true;
    loop_.change(channel_.get(), Interest::nothing, *this);
  } else if (auto* client = std::get_if<OpenConnection>(&message)) {
    clients_.push_back(std::move(*client));
  } else if (std::holds_alternative<Beat>(message)) {
    last_beat_ = now;
    on_beat_();
  }
}

void Worker::make_room() { send(channel_.get(), Kind::make_room); }

void Worker::beat() { send(channel_.get(), Kind::beat); }

void Worker::terminate(int signal) { child_.signal(signal); }

Worker::End Worker::end() {
  const auto status = child_.kill();
  if (!status) return {false, false, "cannot be killed (it hangs in a system call)"};
  return {ended_well(*status), true, describe_end(*status)};
}

}  // namespace coupler::device
