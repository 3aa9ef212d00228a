// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/open_socket.hpp"

#include <gmock/gmock.h>

#include <netdb.h>

#include <future>
#include <vector>

#include "test/host/modbus/modbus_server.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;
using std::chrono::minutes;
using test::LoopbackSocket;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// What getaddrinfo() would have found.
class Addresses {
 public:
  void add(std::uint32_t host, std::uint16_t port) {
    sockaddr_in& address = sockets_.emplace_back();
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(host);
    address.sin_port = htons(port);
  }
  const addrinfo* list() {
    list_.resize(sockets_.size());
    for (std::size_t i = 0; i < list_.size(); ++i) {
      list_[i].ai_family = AF_INET;
      list_[i].ai_addr = reinterpret_cast<sockaddr*>(&sockets_[i]);
      list_[i].ai_addrlen = sizeof sockets_[i];
      list_[i].ai_next = i + 1 < list_.size() ? &list_[i + 1] : nullptr;
    }
    return list_.data();
  }

 private:
  std::vector<sockaddr_in> sockets_;
  std::vector<addrinfo> list_;
};

std::string failure(Addresses addresses) {
  const auto connected = connect_to_one(addresses.list(), "cell port 502", Deadline(minutes(1)), Event());
  return connected ? "connected" : to_string(connected.error());
}

/// Who connects gets no answer: its queue is full.
struct BlackHole {
  BlackHole() {
    socket.listen(0);
    Addresses self;
    self.add(INADDR_LOOPBACK, socket.port());
    auto connected = connect_to_one(self.list(), "", Deadline(minutes(1)), Event());
    if (connected) first = std::move(*connected);
  }
  LoopbackSocket socket;
  Descriptor first;
};

TEST(OpenSocket, An_address_that_is_silent_has_its_share_of_the_time_and_the_next_one_is_tried) {
  constexpr int count = 1000;
  const BlackHole silent;
  LoopbackSocket listener;
  listener.listen(1);
  Addresses addresses;
  addresses.add(INADDR_LOOPBACK, silent.socket.port());
  for (int i = 1; i < count; ++i) addresses.add(INADDR_LOOPBACK, listener.port());
  Event interrupt;
  auto connected = std::async(std::launch::async, [&] {
    // Half a second for each.
    return connect_to_one(addresses.list(), "", Deadline(milliseconds(500) * count), interrupt);
  });
  EXPECT_EQ(connected.wait_for(minutes(2)), std::future_status::ready) << "all of them have 500 s";
  interrupt.set();
  EXPECT_TRUE(connected.get());
}

TEST(OpenSocket, Addresses_that_fail_differently_are_named_in_whatever_order_they_come) {
  const LoopbackSocket nobody;  // does not listen
  Addresses one, two;
  one.add(INADDR_LOOPBACK, nobody.port());
  one.add(INADDR_NONE, nobody.port());  // a broadcast, which TCP cannot reach
  two.add(INADDR_NONE, nobody.port());
  two.add(INADDR_LOOPBACK, nobody.port());
  const std::string text = failure(one);
  EXPECT_THAT(text, StartsWith("cell port 502: 127.0.0.1: Connection refused; 255.255.255.255: "));
  EXPECT_EQ(failure(two), text);
}

TEST(OpenSocket, What_is_wrong_with_all_addresses_is_said_once) {
  const LoopbackSocket nobody;
  Addresses addresses;
  addresses.add(INADDR_LOOPBACK, nobody.port());
  EXPECT_EQ(failure(addresses), "cell port 502: Connection refused");
  addresses.add(INADDR_LOOPBACK + 1, nobody.port());
  EXPECT_EQ(failure(addresses), "cell port 502: Connection refused");
}

TEST(OpenSocket, An_interrupt_ends_the_attempt_and_no_other_is_made) {
  const BlackHole silent;
  LoopbackSocket listener;
  listener.listen(1);
  Addresses addresses;
  addresses.add(INADDR_LOOPBACK, silent.socket.port());
  addresses.add(INADDR_LOOPBACK, listener.port());
  Event interrupt;
  interrupt.set();
  const auto connected = connect_to_one(addresses.list(), "", Deadline(minutes(1)), interrupt);
  ASSERT_FALSE(connected);
  EXPECT_EQ(to_string(connected.error()), "interrupted");
}

TEST(OpenSocket, A_name_that_nobody_could_look_up_is_not_called_unknown) {
  for (const auto& status : {std::optional<int>(), std::optional<int>(EAI_AGAIN)})
    EXPECT_THAT(lookup_failure("cell", status).why,
                AllOf(HasSubstr("'cell' could not be looked up"), HasSubstr("name server"),
                      HasSubstr("give the IP address"), Not(HasSubstr("map"))));
  EXPECT_THAT(lookup_failure("cell", EAI_NONAME).why,
              AllOf(HasSubstr("unknown host 'cell'"), HasSubstr("check the address")));
}

}  // namespace
}  // namespace coupler::host
