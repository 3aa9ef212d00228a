// SPDX-License-Identifier: Apache-2.0
#include "coupler/tls/stream.hpp"

#include <gtest/gtest.h>
#include <poll.h>

#include <array>
#include <memory>
#include <string>

#include "test/common/tls/tls_pair.hpp"

namespace coupler::tls {
namespace {

/// A server that asks for no certificate, and a client of it, in one thread.
class StreamTest : public testing::Test {
 protected:
  /// What comes at one end when the other one takes its part, too; "": its end, or a failure.
  static std::string next(Stream& reader, Stream& other) {
    std::array<char, 256> text{};
    for (int i = 0; i < 100; ++i) {
      const Stream::Progress got = reader.read(text.data(), text.size());
      if (got.bytes > 0) return {text.data(), static_cast<std::size_t>(got.bytes)};
      if (got.wants == 0) return {};
      other.is_there();  // takes what has come, and answers it
    }
    return "nothing";
  }
  void shake_hands() {
    for (int i = 0; i < 3; ++i) {
      client_->is_there();
      server_->is_there();
    }
  }
  static void write(Stream& stream, const std::string& text) {
    EXPECT_EQ(stream.write(text.data(), text.size()).bytes, static_cast<int>(text.size()));
  }

  SocketPair sockets_;
  const Context server_context_ = Context::for_strangers(credentials_of(test_node())).value();
  const Context client_context_ = Context::make(Side::client, credentials_of(test_client())).value();
  std::unique_ptr<Stream> server_ = std::make_unique<Stream>(server_context_, sockets_[0]);
  std::unique_ptr<Stream> client_ = std::make_unique<Stream>(client_context_, sockets_[1]);
};

TEST_F(StreamTest, Nothing_has_come_is_no_failure) {
  char byte = 0;
  const Stream::Progress none = server_->read(&byte, 1);
  EXPECT_EQ(none.bytes, 0);
  EXPECT_EQ(none.wants, POLLIN);
  EXPECT_TRUE(server_->is_there());
}

TEST_F(StreamTest, Bytes_go_both_ways_and_not_as_they_are) {
  shake_hands();
  write(*client_, "a request");
  std::array<char, 256> sent{};
  const ssize_t size = ::recv(sockets_[0], sent.data(), sent.size(), MSG_PEEK | MSG_DONTWAIT);
  ASSERT_GT(size, 0);
  EXPECT_EQ(std::string(sent.data(), static_cast<std::size_t>(size)).find("request"), std::string::npos);
  EXPECT_EQ(next(*server_, *client_), "a request");
  write(*server_, "an answer");
  EXPECT_EQ(next(*client_, *server_), "an answer");
}

TEST_F(StreamTest, What_was_not_read_comes_next) {
  shake_hands();
  write(*client_, "abc");
  char byte = 0;
  ASSERT_EQ(server_->read(&byte, 1).bytes, 1);
  EXPECT_EQ(byte, 'a');
  EXPECT_EQ(next(*server_, *client_), "bc");
}

TEST_F(StreamTest, What_is_decrypted_and_not_read_is_told) {
  shake_hands();
  write(*client_, "abc");
  char byte = 0;
  ASSERT_EQ(server_->read(&byte, 1).bytes, 1);
  EXPECT_TRUE(server_->has_pending());
  EXPECT_EQ(next(*server_, *client_), "bc");
  EXPECT_FALSE(server_->has_pending());
}

TEST_F(StreamTest, A_key_update_is_answered_and_carries_on) {
  shake_hands();
  ASSERT_EQ(SSL_key_update(client_->ssl(), SSL_KEY_UPDATE_REQUESTED), 1);
  write(*client_, "with the new key");
  EXPECT_EQ(next(*server_, *client_), "with the new key");
  write(*server_, "its answer");
  EXPECT_EQ(next(*client_, *server_), "its answer");
}

TEST_F(StreamTest, Key_updates_without_end_end_it) {
  shake_hands();
  char byte = 0;
  for (int i = 0; i < 100 && !server_->has_failed(); ++i) {
    SSL_key_update(client_->ssl(), SSL_KEY_UPDATE_NOT_REQUESTED);
    SSL_do_handshake(client_->ssl());
    server_->read(&byte, 1);
  }
  EXPECT_NE(server_->problem(), "");
}

TEST_F(StreamTest, Its_end_is_told_and_seen) {
  shake_hands();
  EXPECT_TRUE(server_->is_there());
  client_->close();
  EXPECT_FALSE(server_->is_there());
  char byte = 0;
  const Stream::Progress end = server_->read(&byte, 1);
  EXPECT_EQ(end.bytes, 0);
  EXPECT_EQ(end.wants, 0);
}

TEST_F(StreamTest, An_end_in_the_handshake_is_a_failure) {
  EXPECT_EQ(client_->shake_hands().wants, POLLIN);
  const char close_notify[] = {0x15, 3, 3, 0, 2, 1, 0};
  ASSERT_EQ(::send(sockets_[0], close_notify, sizeof close_notify, MSG_NOSIGNAL), 7);
  const Stream::Progress ended = client_->shake_hands();
  EXPECT_EQ(ended.bytes, 0);
  EXPECT_EQ(ended.wants, 0);
  EXPECT_TRUE(client_->has_failed());
  EXPECT_NE(client_->problem(), "");
}

TEST_F(StreamTest, What_is_no_TLS_is_a_failure) {
  ASSERT_GT(::send(sockets_[1], "GET / HTTP/1.1\r\n\r\n", 18, MSG_NOSIGNAL), 0);
  char byte = 0;
  const Stream::Progress failed = server_->read(&byte, 1);
  EXPECT_EQ(failed.bytes, 0);
  EXPECT_EQ(failed.wants, 0);
  EXPECT_FALSE(server_->is_there());
}

}  // namespace
}  // namespace coupler::tls
