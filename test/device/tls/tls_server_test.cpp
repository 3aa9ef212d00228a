// SPDX-License-Identifier: Apache-2.0
// Whom a TLS server hands over, and what becomes of those that stay outside.
#include <arpa/inet.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include <list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "coupler/device/net/client_address.hpp"
#include "coupler/device/tls/tls_server.hpp"
#include "test/common/tls/tls_pair.hpp"
#include "test/device/core/fake_log.hpp"

namespace coupler::device {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// A connected, non-blocking socket that comes from 127.0.0.`host`.
Descriptor connect_to(const std::string& server, std::uint8_t host) {
  Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK - 1 + host);
  EXPECT_EQ(::bind(socket.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  address.sin_port = htons(static_cast<std::uint16_t>(std::stoi(server.substr(server.rfind(':') + 1))));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(::connect(socket.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  ::fcntl(socket.get(), F_SETFL, O_NONBLOCK);
  return socket;
}

/// A client, and what it says and hears.
struct TlsClient {
  TlsClient(const std::string& server, const Credentials& credentials, std::uint8_t host = 1)
      : socket(connect_to(server, host)),
        context(tls::Context::make(tls::Side::client, credentials).value()),
        session(context, socket.get(), tls::TlsPair::for_server("press")) {}

  void step() {
    if (session.state() == tls::Session::State::handshake &&
        session.shake_hands() == tls::Session::State::open)
      session.carry(side[0]);
    if (session.state() == tls::Session::State::open) session.pump();
  }
  bool is_open() const { return session.state() == tls::Session::State::open; }

  Descriptor socket;
  tls::Context context;
  tls::SocketPair side;
  tls::Session session;
};

class TlsServerTest : public testing::Test {
 protected:
  TlsServerTest() { serve(); }

  /// With these roles and authorities.
  void serve(std::vector<std::string> roles = {"operator"},
             Credentials credentials = tls::credentials_of(tls::test_node())) {
    auto shared = listener_.share();
    ASSERT_TRUE(shared) << shared.error();
    server_.put_in_force(*std::move(shared),
                         {tls::Context::make(tls::Side::server, credentials).value(), std::move(roles)});
  }
  TlsClient& client(const std::string& role = "operator", std::uint8_t host = 1) {
    return clients_.emplace_back(listener_.name, tls::credentials_of(tls::test_client(role)), host);
  }
  void settle() {
    for (int i = 0; i < 40; ++i) {
      for (TlsClient& each : clients_) each.step();
      now_ = loop_.run_once(std::chrono::milliseconds(1));
      server_.tick(now_);
    }
  }

  Loop loop_;
  FakeLog log_;
  Listener listener_ = listen_on("127.0.0.1", 0).value();
  std::vector<OpenConnection> handed_over_;
  bool is_taken_ = true;  ///< what is handed over
  TlsServer server_{loop_, log_, [this](const OpenConnection& client) {
                      if (!is_taken_) return false;
                      OpenConnection copy;
                      copy.socket = Descriptor(::fcntl(client.socket.get(), F_DUPFD_CLOEXEC, 0));
                      copy.tls = client.tls;
                      handed_over_.push_back(std::move(copy));
                      return true;
                    }};
  std::list<TlsClient> clients_;
  TimePoint now_{};
};

TEST_F(TlsServerTest, Hands_over_a_client_with_its_name_role_and_address) {
  TlsClient& one = client();
  settle();
  ASSERT_TRUE(one.is_open()) << one.session.problem();
  ASSERT_EQ(handed_over_.size(), 1U);
  EXPECT_EQ(handed_over_[0].tls->name.view(), "cell1");
  EXPECT_EQ(handed_over_[0].tls->role.view(), "operator");
  EXPECT_EQ(origin_of(handed_over_[0].tls->address)[15], 1);
  tls::put(one.side[1], "question");
  settle();
  EXPECT_EQ(tls::received(handed_over_[0].socket.get()), "question");
  tls::put(handed_over_[0].socket.get(), "answer");
  settle();
  EXPECT_EQ(tls::received(one.side[1]), "answer");
}

TEST_F(TlsServerTest, Without_room_for_a_descriptor_it_waits_before_it_tries_again) {
  client();
  settle();
  // UBSan needs a descriptor the first time it sees a type called: let it see these before there are none.
  Log& log = log_;
  log.write("begins");
  const TlsClient& one = client();
  rlimit descriptors{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &descriptors), 0);
  const rlimit none{0, descriptors.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  const TimePoint now = loop_.run_once(std::chrono::seconds(20));
  server_.tick(now);
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &descriptors), 0);
  EXPECT_THAT(log_.lines, Contains(HasSubstr("Too many open files; trying again")));
  EXPECT_GT(server_.time_until_due(now), std::chrono::milliseconds(0)) << "not at once";
  server_.tick(now + std::chrono::seconds(1));
  EXPECT_EQ(server_.time_until_due(now), std::nullopt);
  settle();
  EXPECT_TRUE(one.is_open());
}

TEST_F(TlsServerTest, Ends_a_client_that_the_other_process_closes_and_the_other_way_round) {
  TlsClient& closed = client();
  settle();
  handed_over_[0].socket.close();
  settle();
  EXPECT_EQ(tls::received(closed.side[1]), "");
  EXPECT_EQ(closed.session.problem(), "");
  TlsClient& leaves = client();
  settle();
  leaves.socket.close();
  settle();
  EXPECT_EQ(tls::received(handed_over_[1].socket.get()), "");
}

TEST_F(TlsServerTest, One_that_nobody_takes_is_ended) {
  is_taken_ = false;
  TlsClient& one = client();
  settle();
  EXPECT_FALSE(one.is_open());
  EXPECT_THAT(log_.lines, Contains(HasSubstr("does not take it")));
}

TEST_F(TlsServerTest, A_role_that_the_map_does_not_have_is_let_in_and_named_with_the_nearest) {
  TlsClient& one = client("operater");
  settle();
  EXPECT_TRUE(one.is_open());
  EXPECT_THAT(log_.lines,
              Contains(HasSubstr("as 'operater', which is no role of the map; did you mean 'operator'?")));
}

TEST_F(TlsServerTest, New_rules_close_whom_they_would_not_let_in) {
  TlsClient& operates = client("operator");
  TlsClient& views = client("viewer");
  serve({"operator", "viewer"});
  settle();
  ASSERT_TRUE(operates.is_open() && views.is_open());
  serve({"operator"});
  settle();
  EXPECT_TRUE(operates.is_open());
  EXPECT_FALSE(views.is_open()) << "its role is gone";
  Credentials of_another = tls::credentials_of(tls::test_node());
  of_another.ca = tls::make_authority("other")->certificate;
  serve({"operator"}, of_another);
  settle();
  EXPECT_FALSE(operates.is_open()) << "its authority is gone";
}

TEST_F(TlsServerTest, A_handshake_does_not_end_by_former_rules) {
  TlsClient& half = client();
  half.session.shake_hands();  // its hello is sent
  loop_.run_once(std::chrono::milliseconds(50));
  loop_.run_once(std::chrono::milliseconds(50));  // it is answered
  serve();
  settle();
  EXPECT_FALSE(half.is_open());
  EXPECT_TRUE(handed_over_.empty());
}

TEST_F(TlsServerTest, Handshakes_are_limited_for_each_address_and_a_newcomer_of_another_one_is_let_in) {
  std::vector<Descriptor> silent;
  for (std::size_t i = 0; i < 2 * TlsServer::most_handshakes_of_one; ++i)
    silent.push_back(connect_to(listener_.name, 66));
  settle();
  EXPECT_LE(server_.size(), TlsServer::most_handshakes_of_one);
  TlsClient& other = client("operator", 2);
  settle();
  EXPECT_TRUE(other.is_open());
}

TEST_F(TlsServerTest, Who_was_refused_and_stays_counts_as_well) {
  std::vector<Descriptor> rude;
  for (std::size_t i = 0; i < 4 * TlsServer::most_handshakes_of_one; ++i) {
    rude.push_back(connect_to(listener_.name, 66));
    EXPECT_EQ(::send(rude.back().get(), "GET / HTTP/1.0\r\n", 16, MSG_NOSIGNAL), 16);
    settle();
  }
  EXPECT_LE(server_.size(), TlsServer::most_handshakes_of_one);
}

TEST_F(TlsServerTest, A_handshake_that_does_not_go_on_ends_after_its_time) {
  const TimePoint before = TimePoint::clock::now();
  const Descriptor silent = connect_to(listener_.name, 1);
  settle();
  EXPECT_EQ(server_.size(), 1U);
  server_.tick(before + TlsConnection::handshake_timeout - std::chrono::milliseconds(500));
  EXPECT_EQ(server_.size(), 1U);
  server_.tick(now_ + TlsConnection::handshake_timeout + std::chrono::milliseconds(1));
  EXPECT_EQ(server_.size(), 0U);
}

}  // namespace
}  // namespace coupler::device
