// SPDX-License-Identifier: Apache-2.0
// A client on its way from one process to another. The one that sends it may be under somebody else's
// control.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <string>

#include "coupler/device/net/open_connection.hpp"

namespace coupler::device {
namespace {

using testing::ElementsAre;
using testing::Optional;

class OpenConnectionTest : public testing::Test {
 protected:
  OpenConnectionTest() {
    std::array<int, 2> pair{};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair.data()), 0);
    clients_end_ = Descriptor(pair[0]);
    client_.socket = Descriptor(pair[1]);
    client_.tls = TlsPeer{{}, ShortText("cell1"), ShortText("operator")};
    client_.unread = {1, 2, 3};
    client_.unsent = {4, 5};
  }

  std::vector<std::uint8_t> sent() {
    EXPECT_TRUE(send_client(channel_->one.get(), client_, Waits::no));
    std::vector<std::uint8_t> bytes(longest_client_message);
    const ssize_t size = receive_message(channel_->other.get(), bytes, came_);
    bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    return bytes;
  }
  /// A byte and two descriptors, as no node sends them.
  void send_both(const std::array<int, 2>& descriptors) {
    std::uint8_t byte = 0;
    iovec part{&byte, 1};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof descriptors)> control{};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    cmsghdr* rights = CMSG_FIRSTHDR(&message);
    rights->cmsg_level = SOL_SOCKET;
    rights->cmsg_type = SCM_RIGHTS;
    rights->cmsg_len = CMSG_LEN(sizeof descriptors);
    std::memcpy(CMSG_DATA(rights), descriptors.data(), sizeof descriptors);
    EXPECT_EQ(::sendmsg(channel_->one.get(), &message, 0), 1);
  }
  static bool is_closed(const Descriptor& end) {
    char byte = 0;
    return ::recv(end.get(), &byte, 1, MSG_DONTWAIT) == 0;
  }
  Descriptor a_socket() { return Descriptor(::dup(clients_end_.get())); }

  std::optional<Channel> channel_ = open_channel();
  Descriptor clients_end_;
  OpenConnection client_;
  Descriptor came_;
};

TEST_F(OpenConnectionTest, Comes_with_its_socket_and_all_that_is_known_of_it) {
  client_.has_asked = true;
  const auto bytes = sent();
  const auto client = parse_client(bytes, std::move(came_));
  ASSERT_TRUE(client);
  EXPECT_TRUE(client->has_asked);
  EXPECT_FALSE(client->has_written);
  EXPECT_THAT(client->unread, ElementsAre(1, 2, 3));
  EXPECT_THAT(client->unsent, ElementsAre(4, 5));
  ASSERT_TRUE(client->tls);
  EXPECT_EQ(client->tls->name.view(), "cell1");
  EXPECT_EQ(client->tls->role.view(), "operator");
  EXPECT_EQ(::write(clients_end_.get(), "x", 1), 1);
  std::array<char, 2> byte{};
  EXPECT_EQ(::read(client->socket.get(), byte.data(), byte.size()), 1);
}

TEST_F(OpenConnectionTest, Is_none_without_a_socket) { EXPECT_FALSE(parse_client(sent(), {})); }

TEST_F(OpenConnectionTest, Of_two_sockets_in_a_message_only_one_comes) {
  std::array<int, 2> first{};
  std::array<int, 2> second{};
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, first.data()), 0);
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, second.data()), 0);
  const Descriptor end_of_first(first[0]);
  const Descriptor end_of_second(second[0]);
  send_both({first[1], second[1]});
  ::close(first[1]);
  ::close(second[1]);
  std::vector<std::uint8_t> bytes(longest_client_message);
  EXPECT_EQ(receive_message(channel_->other.get(), bytes, came_), 1);
  EXPECT_TRUE(came_.is_open());
  EXPECT_TRUE(is_closed(end_of_second)) << "the other one stays open, and nobody knows it";
  EXPECT_FALSE(is_closed(end_of_first));
}

TEST_F(OpenConnectionTest, Is_none_of_another_length_than_it_says) {
  auto bytes = sent();
  bytes.push_back(0);
  EXPECT_FALSE(parse_client(bytes, a_socket()));
  bytes.resize(bytes.size() - 2);
  EXPECT_FALSE(parse_client(bytes, a_socket()));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(parse_client(Span<const std::uint8_t>(bytes).first(size), a_socket())) << size;
}

TEST_F(OpenConnectionTest, Is_none_with_more_than_a_connection_can_hold) {
  client_.unread.assign(longest_unread, 7);
  client_.unsent.assign(longest_unsent, 8);
  EXPECT_TRUE(parse_client(sent(), a_socket()));
  client_.unread.push_back(7);
  EXPECT_FALSE(parse_client(sent(), a_socket()));
  client_.unread.clear();
  client_.unsent.push_back(8);
  EXPECT_FALSE(parse_client(sent(), a_socket()));
}

TEST_F(OpenConnectionTest, Any_bytes_are_one_that_can_be_taken_over_or_none) {
  const auto good = sent();
  for (std::size_t at = 0; at < good.size(); ++at)
    for (const int value : {0, 1, 2, 0x7F, 0x80, 0xFF}) {
      auto bytes = good;
      bytes[at] = static_cast<std::uint8_t>(value);
      const auto client = parse_client(bytes, a_socket());
      if (!client) continue;
      EXPECT_LE(client->unread.size(), longest_unread);
      EXPECT_LE(client->unsent.size(), longest_unsent);
      if (!client->tls) continue;
      EXPECT_LE(client->tls->name.view().size(), ShortText::capacity);
      EXPECT_LE(client->tls->role.view().size(), ShortText::capacity);
    }
}

TEST(ShortText, Is_cut_to_64_bytes) {
  EXPECT_EQ(ShortText("abc").view(), "abc");
  EXPECT_EQ(ShortText(std::string(65, 'x')).view(), std::string(64, 'x'));
  EXPECT_EQ(ShortText("").view(), "");
}

}  // namespace
}  // namespace coupler::device
