// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/net/message.hpp"

#include <sys/socket.h>

#include <array>
#include <cassert>
#include <cerrno>
#include <cstring>

namespace coupler::device {
namespace {

constexpr std::size_t most_parts = 4;

/// Memory for one descriptor beside a message.
union Control {
  cmsghdr alignment;
  std::array<char, CMSG_SPACE(sizeof(int))> bytes;
};

}  // namespace

std::optional<Channel> open_channel() {
  std::array<int, 2> pair{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, pair.data()) != 0) return std::nullopt;
  return Channel{Descriptor(pair[0]), Descriptor(pair[1])};
}

bool send_message(int socket, std::initializer_list<Span<const std::uint8_t>> parts, int descriptor,
                  Waits waits) {
  assert(parts.size() <= most_parts);
  std::array<iovec, most_parts> of{};
  std::size_t count = 0;
  // sendmsg() does not change what it sends.
  for (const auto& part : parts) of[count++] = {const_cast<std::uint8_t*>(part.data()), part.size()};
  Control control{};
  msghdr message{};
  message.msg_iov = of.data();
  message.msg_iovlen = count;
  if (descriptor >= 0) {
    message.msg_control = control.bytes.data();
    message.msg_controllen = sizeof control.bytes;
    cmsghdr* rights = CMSG_FIRSTHDR(&message);
    rights->cmsg_level = SOL_SOCKET;
    rights->cmsg_type = SCM_RIGHTS;
    rights->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(rights), &descriptor, sizeof descriptor);
  }
  const int flags = MSG_NOSIGNAL | (waits == Waits::no ? MSG_DONTWAIT : 0);
  ssize_t sent = 0;
  do sent = ::sendmsg(socket, &message, flags);
  while (sent < 0 && errno == EINTR);
  return sent >= 0;
}

ssize_t receive_message(int socket, Span<std::uint8_t> room, Descriptor& descriptor) {
  iovec part{room.data(), room.size()};
  Control control{};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.bytes.data();
  message.msg_controllen = CMSG_LEN(sizeof(int));  // all of `control` would have room for a second one
  const ssize_t size = ::recvmsg(socket, &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
  const cmsghdr* rights = size < 0 ? nullptr : CMSG_FIRSTHDR(&message);
  if (rights != nullptr && rights->cmsg_type == SCM_RIGHTS) {
    int fd = -1;
    std::memcpy(&fd, CMSG_DATA(rights), sizeof fd);
    descriptor = Descriptor(fd);
  }
  return size;
}

}  // namespace coupler::device
