// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <array>
#include <cstddef>
#include <string>

#include "coupler/device/node/service_manager.hpp"
#include "coupler/device/supervisor/heartbeat.hpp"

namespace coupler::device {
namespace {

/// A manager's socket with a name that the kernel chooses.
class Managed : public testing::Test {
 protected:
  Managed() : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    auto* any = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(::bind(socket_.get(), any, sizeof address.sun_family), 0);
    socklen_t size = sizeof address;
    EXPECT_EQ(::getsockname(socket_.get(), any, &size), 0);
    name_.assign(address.sun_path, size - offsetof(sockaddr_un, sun_path));
    name_[0] = '@';
  }

  /// The next piece of news; empty: there is none.
  std::string news() {
    std::array<char, 200> text{};
    const ssize_t size = ::recv(socket_.get(), text.data(), text.size(), MSG_DONTWAIT);
    return size < 0 ? "" : std::string(text.data(), static_cast<std::size_t>(size));
  }

  Descriptor socket_;
  std::string name_;
};

TEST_F(Managed, Only_a_loop_that_turns_is_ready) {
  ServiceManager manager(name_.c_str(), nullptr);
  manager.set_status("serving plant");
  ASSERT_TRUE(manager.is_there());
  EXPECT_EQ(news(), "");
  for (int i = 0; i < 100; ++i) manager.beat();
  EXPECT_EQ(news(), "READY=1\nSTATUS=serving plant");
  EXPECT_EQ(news(), "") << "it did not ask for more";
  manager.stopping();
  EXPECT_EQ(news(), "STOPPING=1");
}

TEST_F(Managed, Its_watchdog_is_fed_twice_in_its_time) {
  ServiceManager manager(name_.c_str(), "2000000");
  manager.beat();
  news();
  int fed = 0;
  for (auto time = heartbeat_period; time < std::chrono::seconds(10); time += heartbeat_period) {
    manager.beat();
    for (std::string text = news(); !text.empty(); text = news()) {
      EXPECT_EQ(text, "WATCHDOG=1");
      ++fed;
    }
  }
  EXPECT_EQ(fed, 10);
}

TEST_F(Managed, A_short_watchdog_is_fed_at_each_beat) {
  ServiceManager manager(name_.c_str(), "1");
  manager.beat();
  news();
  EXPECT_EQ(news(), "WATCHDOG=1");
  manager.beat();
  EXPECT_EQ(news(), "WATCHDOG=1");
}

TEST_F(Managed, A_reload_is_told_with_its_time_and_its_end) {
  ServiceManager manager(name_.c_str(), nullptr);
  manager.beat();
  news();
  manager.reloading(TimePoint(std::chrono::microseconds(1234567)));
  EXPECT_EQ(news(), "RELOADING=1\nMONOTONIC_USEC=1234567");
  manager.ready("serving more");
  EXPECT_EQ(news(), "READY=1\nSTATUS=serving more");
}

TEST_F(Managed, A_manager_that_does_not_read_blocks_nobody) {
  ServiceManager manager(name_.c_str(), "1");
  for (int i = 0; i < 100'000; ++i) manager.beat();
}

TEST(Unmanaged, Nobody_is_told) {
  for (const char* socket : {static_cast<const char*>(nullptr), "", "/nowhere/notify", "@nobody"}) {
    ServiceManager manager(socket, "1");
    EXPECT_FALSE(manager.is_there());
    manager.beat();
    manager.stopping();
  }
}

}  // namespace
}  // namespace coupler::device
