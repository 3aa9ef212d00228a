// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/supervisor/channel.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cstring>

namespace coupler::device::channel {
namespace {

enum class Kind : std::uint8_t { beat, make_room, client };

/// The beginning of each message; what of a client is unread and unsent follows.
struct Head {
  Kind kind;
  bool has_written = false;
  std::uint16_t unread = 0;
  std::uint16_t unsent = 0;
};

constexpr std::size_t longest_body = 4096;

void send_head(int socket, Kind kind) {
  const Head head{kind};
  (void)::send(socket, &head, sizeof head, MSG_DONTWAIT | MSG_NOSIGNAL);
}

/// Room for one descriptor beside a message.
union Control {
  cmsghdr alignment;
  std::array<char, CMSG_SPACE(sizeof(int))> bytes;
};

Descriptor descriptor_of(msghdr& message) {
  const cmsghdr* control = CMSG_FIRSTHDR(&message);
  if (control == nullptr || control->cmsg_type != SCM_RIGHTS) return {};
  int fd = -1;
  std::memcpy(&fd, CMSG_DATA(control), sizeof fd);
  return Descriptor(fd);
}

}  // namespace

std::optional<Pair> open() {
  std::array<int, 2> pair{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, pair.data()) != 0) return std::nullopt;
  return Pair{Descriptor(pair[0]), Descriptor(pair[1])};
}

void send(int socket, Beat) { send_head(socket, Kind::beat); }
void send(int socket, MakeRoom) { send_head(socket, Kind::make_room); }

void send(int socket, const OpenConnection& client) {
  assert(client.unread.size() + client.unsent.size() <= longest_body);
  Head head{Kind::client, client.has_written, static_cast<std::uint16_t>(client.unread.size()),
            static_cast<std::uint16_t>(client.unsent.size())};
  // sendmsg() does not change what it sends.
  std::array<iovec, 3> parts{{{&head, sizeof head},
                              {const_cast<std::uint8_t*>(client.unread.data()), client.unread.size()},
                              {const_cast<std::uint8_t*>(client.unsent.data()), client.unsent.size()}}};
  Control control{};
  msghdr message{};
  message.msg_iov = parts.data();
  message.msg_iovlen = parts.size();
  message.msg_control = control.bytes.data();
  message.msg_controllen = sizeof control.bytes;
  cmsghdr* rights = CMSG_FIRSTHDR(&message);
  rights->cmsg_level = SOL_SOCKET;
  rights->cmsg_type = SCM_RIGHTS;
  rights->cmsg_len = CMSG_LEN(sizeof(int));
  const int fd = client.socket.get();
  std::memcpy(CMSG_DATA(rights), &fd, sizeof fd);
  while (::sendmsg(socket, &message, MSG_NOSIGNAL) < 0 && errno == EINTR) {
  }
}

Message receive(int socket) {
  Head head{};
  std::array<std::uint8_t, longest_body> body{};
  std::array<iovec, 2> parts{{{&head, sizeof head}, {body.data(), body.size()}}};
  Control control{};
  msghdr message{};
  message.msg_iov = parts.data();
  message.msg_iovlen = parts.size();
  message.msg_control = control.bytes.data();
  message.msg_controllen = sizeof control.bytes;
  const ssize_t size = ::recvmsg(socket, &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
  // An error (the other process ended and left something unread) is told once; what it said comes after that.
  if (size < 0) return Nothing{};
  if (size == 0) return Ended{};
  if (head.kind == Kind::beat) return Beat{};
  if (head.kind == Kind::make_room) return MakeRoom{};
  OpenConnection client{descriptor_of(message), head.has_written};
  client.unread.assign(body.begin(), body.begin() + head.unread);
  client.unsent.assign(body.begin() + head.unread, body.begin() + head.unread + head.unsent);
  return client;
}

}  // namespace coupler::device::channel
