// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <poll.h>

#include "test/common/tls/tls_pair.hpp"

namespace coupler::tls {
namespace {

using testing::HasSubstr;

struct TlsSession : testing::Test {
  TlsSession() { pair.shake_hands(); }
  TlsPair pair{credentials_of(test_node()), credentials_of(test_client())};
};

TEST_F(TlsSession, Carries_bytes_both_ways) {
  ASSERT_TRUE(pair.are_open()) << pair.server.problem() << pair.client.problem();
  put(pair.client_side[1], "question");
  pair.pump();
  EXPECT_EQ(received(pair.server_side[1]), "question");
  put(pair.server_side[1], "answer");
  pair.pump();
  EXPECT_EQ(received(pair.client_side[1]), "answer");
}

TEST_F(TlsSession, The_end_of_one_side_comes_after_what_it_said_and_the_other_can_still_answer) {
  put(pair.client_side[1], "question");
  ::shutdown(pair.client_side[1], SHUT_WR);
  pair.pump();
  // The client's own pump has ended with its close_notify, so only what it said is looked at.
  EXPECT_EQ(received(pair.server_side[1]), "question");
  EXPECT_EQ(received(pair.server_side[1]), "");
  EXPECT_EQ(pair.server.state(), Session::State::open);
  pair.server_side.close(1);
  pair.pump();
  EXPECT_EQ(pair.server.state(), Session::State::ended);
  EXPECT_EQ(pair.server.problem(), "");
}

TEST_F(TlsSession, A_peer_that_leaves_without_a_word_is_no_problem) {
  pair.wire.close(1);
  pair.pump();
  EXPECT_EQ(pair.server.state(), Session::State::ended);
  EXPECT_EQ(pair.server.problem(), "");
  EXPECT_EQ(received(pair.server_side[1]), "-") << "who closes it is for whoever owns it";
}

TEST_F(TlsSession, Keeps_little_for_who_does_not_read) {
  const std::string block(2048, 'x');
  std::size_t put = 0;
  for (int i = 0; i < 1000; ++i) {
    const ssize_t size = ::send(pair.client_side[1], block.data(), block.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (size < 0) break;
    put += static_cast<std::size_t>(size);
    pair.pump();
  }
  EXPECT_LT(put, std::size_t{1} << 20) << "the kernel's buffers, and two of ours";
  EXPECT_NE(pair.server.wants().plain & POLLOUT, 0);
  EXPECT_EQ(pair.server.wants().socket & POLLIN, 0);
  std::size_t got = 0;
  for (std::string text = "x"; !text.empty() && text != "-"; got += text == "-" ? 0 : text.size()) {
    text = received(pair.server_side[1]);
    pair.pump();
  }
  EXPECT_EQ(got, put);
}

TEST_F(TlsSession, Key_updates_are_answered_but_not_a_flood_of_them) {
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(SSL_key_update(pair.client.ssl(), SSL_KEY_UPDATE_REQUESTED), 1);
    put(pair.client_side[1], "still here");
    pair.pump();
    EXPECT_EQ(received(pair.server_side[1]), "still here");
  }
  for (int i = 0; i < 100 && pair.server.state() == Session::State::open; ++i) {
    SSL_key_update(pair.client.ssl(), SSL_KEY_UPDATE_NOT_REQUESTED);
    SSL_do_handshake(pair.client.ssl());
    pair.server.pump();
  }
  EXPECT_EQ(pair.server.state(), Session::State::ended);
  EXPECT_THAT(pair.server.problem(), HasSubstr("messages of the handshake"));
}

TEST(TlsHandshake, Of_something_else_says_so) {
  TlsPair pair(credentials_of(test_node()), credentials_of(test_client()));
  put(pair.wire[1], std::string("\0\1\0\0\0\6\1\1\0\0\0\1", 12));
  EXPECT_EQ(pair.server.shake_hands(), Session::State::ended);
  EXPECT_EQ(pair.server.problem(), "the other side does not speak TLS");
}

}  // namespace
}  // namespace coupler::tls
