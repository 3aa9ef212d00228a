// SPDX-License-Identifier: Apache-2.0
// A generated client, config/examples/pump: what calls back.
#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "test/host/client/pump_client_fixture.hpp"

namespace coupler::client {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;

TEST_F(PumpClient, Changes_are_told_and_nothing_else) {
  std::mutex mutex;
  std::vector<double> told;
  pump.pressure.on_change([&](double bar) {
    const std::lock_guard lock(mutex);
    told.push_back(bar);
  });
  pump.connect();
  const auto seen = [&](std::size_t count) {
    return becomes([&] {
      const std::lock_guard lock(mutex);
      return told.size() >= count;
    });
  };
  ASSERT_TRUE(seen(1));
  const int several = server.requests + 20;  // polls of the same value
  ASSERT_TRUE(becomes([&] { return server.requests >= several; }));
  server.tables().tab_input_registers[0] = 150;
  ASSERT_TRUE(seen(2));
  pump.disconnect();
  EXPECT_THAT(told, ElementsAre(0, 1.5));
}

/// A callback is taken back while it runs, which it may have done itself before.
struct TakenBack : PumpClient {
  void expect_end(bool also_by_itself) {
    std::atomic<bool> begun{false};
    std::atomic<bool> ended{false};
    pump.running.on_change([&](bool) {
      if (also_by_itself) pump.running.on_change({});
      begun = true;
      std::this_thread::sleep_for(50ms);
      ended = true;
    });
    pump.connect();
    ASSERT_TRUE(becomes([&] { return begun.load(); }));
    pump.running.on_change({});
    EXPECT_TRUE(ended);
  }
};

TEST_F(TakenBack, It_runs_no_more_then) { expect_end(false); }
TEST_F(TakenBack, Nor_if_it_has_done_so_itself) { expect_end(true); }

TEST_F(PumpClient, A_callback_may_take_itself_and_others_back) {
  std::atomic<int> calls{0};
  const auto count_one = [&](const auto&) {
    ++calls;
    pump.pressure.on_change({});
    pump.starts.on_change({});
  };
  pump.pressure.on_change(count_one);
  pump.starts.on_change(count_one);
  pump.connect();
  ASSERT_TRUE(pump.pressure.wait(soon));
  ASSERT_TRUE(pump.starts.wait(soon));
  pump.disconnect();
  EXPECT_EQ(calls, 1);
}

TEST_F(PumpClient, What_a_callback_throws_is_reported_once) {
  Reports reports;
  Options listening = options();
  listening.on_report = [&](Level, const std::string& text) {
    reports.add(text);
    throw std::runtime_error("nor is this one's end the connection's");
  };
  std::atomic<int> calls{0};
  maps::pump::Client other(listening);
  other.pressure.on_change([&](double) {
    ++calls;
    throw std::out_of_range("of the table");
  });
  other.connect();
  ASSERT_TRUE(becomes([&] { return calls == 1; }));
  server.tables().tab_input_registers[0] = 150;
  ASSERT_TRUE(becomes([&] { return calls == 2; }));
  EXPECT_TRUE(other.valve.set(true).get());
  other.disconnect();
  EXPECT_EQ(std::count_if(reports.texts.begin(), reports.texts.end(),
                          [](const std::string& text) {
                            return text.find("pressure: its callback threw an exception: of the table") == 0;
                          }),
            1);
}

TEST_F(PumpClient, A_change_has_the_time_at_which_it_was_true) {
  std::mutex mutex;
  std::optional<host::Stamp> told;
  pump.running.on_stamped_change([&](bool, host::Stamp stamp) {
    const std::lock_guard lock(mutex);
    told = stamp;
  });
  const auto before = std::chrono::steady_clock::now();
  pump.connect();
  ASSERT_TRUE(becomes([&] {
    const std::lock_guard lock(mutex);
    return told.has_value();
  }));
  EXPECT_GE(told->at + told->uncertainty, before);
  EXPECT_LE(told->at - told->uncertainty, std::chrono::steady_clock::now());
}

TEST_F(PumpClient, A_change_may_be_answered_by_setting_a_point) {
  std::atomic<bool> asked{false};
  pump.running.on_change([&](bool) {
    pump.speed.set(12.5);
    asked = true;
  });
  pump.connect();
  ASSERT_TRUE(becomes([&] { return asked && server.tables().tab_registers[0] == 125; }));
}

TEST_F(PumpClient, It_is_told_when_the_device_comes_and_goes) {
  std::mutex mutex;
  std::vector<bool> told;
  std::vector<bool> was_online;
  pump.on_online([&](bool online) {
    const std::lock_guard lock(mutex);
    told.push_back(online);
    was_online.push_back(pump.online());
    if (online) pump.speed.set(12.5);
  });
  const auto seen = [&](std::size_t count) {
    return becomes([&] {
      const std::lock_guard lock(mutex);
      return told.size() >= count;
    });
  };
  pump.connect();
  ASSERT_TRUE(seen(1));
  EXPECT_TRUE(becomes([&] { return server.tables().tab_registers[0] == 125; }));
  pump.disconnect();
  EXPECT_THAT(told, ElementsAre(true, false)) << "before disconnect() has returned";
  pump.connect();
  ASSERT_TRUE(seen(3));
  pump.on_online({});
  pump.disconnect();
  EXPECT_THAT(told, ElementsAre(true, false, true));
  EXPECT_EQ(was_online, told);
}

TEST_F(PumpClient, What_it_throws_when_told_so_is_reported_and_the_connection_goes_on) {
  Reports reports;
  Options listening = options();
  listening.on_report = [&](Level, const std::string& text) { reports.add(text); };
  maps::pump::Client other(listening);
  other.on_online([](bool) { throw std::runtime_error("no recipe"); });
  other.connect();
  EXPECT_TRUE(other.running.wait(soon));
  other.disconnect();
  EXPECT_THAT(
      reports.texts,
      ::testing::Contains(::testing::HasSubstr("on_online: its callback threw an exception: no recipe")));
}

}  // namespace
}  // namespace coupler::client
