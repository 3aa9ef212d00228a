// SPDX-License-Identifier: Apache-2.0
// Several units on one serial line.
#include <gmock/gmock.h>

#include <unistd.h>

#include <atomic>
#include <future>
#include <string>
#include <thread>

#include "coupler/host/core/device_thread.hpp"
#include "coupler/host/modbus/make_links.hpp"
#include "test/fakes/map_builder.hpp"
#include "test/host/modbus/listeners.hpp"
#include "test/host/modbus/serial_line.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Each answers with its number.
class SerialUnits : public ::testing::Test {
 protected:
  void make(const std::vector<std::uint8_t>& units) {
    std::vector<Map> maps;
    for (const std::uint8_t unit : units) maps.push_back(map_of(unit));
    links = make_links(maps);
  }
  Map map_of(std::uint8_t unit, milliseconds timeout = milliseconds(20000)) const {
    Map map;
    map.name = unit == 1 ? "left" : "right";
    map.connection = line.connection(unit, timeout);
    return map;
  }
  Result<std::uint16_t> read(Link& link) const {
    std::uint16_t word = 0;
    auto done = link.read(Table::holding_registers, modbus::Range::of(0, 1), &word);
    return done ? Result<std::uint16_t>(word) : tl::make_unexpected(done.error());
  }

  std::atomic<int> silent{0};
  std::atomic<int> unanswered{0};  ///< so many requests to it have come
  test::SerialLine line{[this](const test::Octets& request) {
    if (request[0] == silent) {
      ++unanswered;
      return test::Octets();
    }
    if (request[1] == 1) return test::rtu(request[0], {1, 1, 1});
    if (request[1] != 3) return test::Octets(request.begin(), request.begin() + 8);
    return test::rtu(request[0], {3, 2, 0, request[0]});
  }};
  std::vector<std::unique_ptr<Link>> links;
};

TEST_F(SerialUnits, Share_the_one_port_in_turn) {
  make({1, 2, 3});
  for (int round = 0; round < 2; ++round)
    for (std::size_t i = 0; i < links.size(); ++i) {
      ASSERT_TRUE(links[i]->connect());
      EXPECT_EQ(read(*links[i]), i + 1);
    }
}

TEST_F(SerialUnits, Go_on_without_a_new_connection_when_one_is_silent) {
  links = make_links({map_of(1), map_of(2, milliseconds(100))});
  for (auto& link : links) ASSERT_TRUE(link->connect());
  silent = 2;
  const auto answer = read(*links[1]);
  ASSERT_FALSE(answer);
  EXPECT_TRUE(std::holds_alternative<Timeout>(answer.error()));
  EXPECT_EQ(read(*links[0]), 1);
  silent = 0;
  Result<std::uint16_t> again = fail(Timeout{milliseconds(100)});
  while (!again && std::holds_alternative<Timeout>(again.error())) {  // a busy machine may be late
    ASSERT_TRUE(links[1]->connect());
    again = read(*links[1]);
  }
  EXPECT_EQ(again, 2);
}

TEST_F(SerialUnits, At_the_end_one_that_is_silent_keeps_no_other_from_its_safe_values) {
  std::vector<MapPtr> owned;
  for (std::uint8_t unit = 1; unit <= 2; ++unit) {
    fakes::MapBuilder builder;
    builder.coil("valve", 1).holding("level", 0);
    builder.head().connection = line.connection(unit, milliseconds(20000));
    builder.head().on_shutdown = OnShutdown::safe;
    owned.push_back(builder.build());
  }
  const auto is_made_safe = [&] {
    links = make_links({owned[0]->map(), owned[1]->map()});
    OnlineSink sink;
    DeafSink deaf;
    ValueTable values(owned[0]->map());
    DeviceThread healthy(owned[0]->map(), Verify::off, MapLoader(), *links[0], values, sink);
    healthy.start();
    while (!sink.is_online) std::this_thread::sleep_for(milliseconds(1));
    silent = 2;
    const int before = unanswered;
    ValueTable none(owned[1]->map());
    DeviceThread dead(owned[1]->map(), Verify::require, MapLoader(), *links[1], none, deaf);
    dead.start();
    while (unanswered == before) std::this_thread::sleep_for(milliseconds(1));
    auto dead_ends = std::async(std::launch::async, [&] { return dead.end(); });
    const bool made_safe = healthy.end();
    EXPECT_FALSE(dead_ends.get());
    return made_safe;
  };
  bool made_safe = false;
  for (int i = 0; i < 20 && !made_safe; ++i) made_safe = is_made_safe();  // a busy machine may be late
  EXPECT_TRUE(made_safe);
}

TEST_F(SerialUnits, Are_all_lost_when_the_port_goes) {
  make({1, 2});
  for (auto& link : links) {
    ASSERT_TRUE(link->connect());
    ASSERT_TRUE(read(*link));
  }
  line.unplug();
  for (auto& link : links) {
    const auto answer = read(*link);
    ASSERT_FALSE(answer);
    EXPECT_TRUE(std::holds_alternative<TransportFailure>(answer.error()));
  }
}

TEST_F(SerialUnits, Of_one_port_by_two_names_share_it) {
  const std::string other_name = ::testing::TempDir() + "coupler_port_" + std::to_string(::getpid());
  ASSERT_EQ(::symlink(line.device().c_str(), other_name.c_str()), 0);
  std::vector<Map> maps{map_of(1), map_of(2)};
  maps[1].connection.serial.device = other_name;
  links = make_links(maps);
  ASSERT_TRUE(links[0]->connect());
  EXPECT_TRUE(links[1]->connect());
  EXPECT_EQ(read(*links[1]), 2);
  EXPECT_THAT(line_conflict(maps), IsEmpty());
  maps[1].connection.serial.baud = 9600;
  EXPECT_THAT(line_conflict(maps), HasSubstr("left and right are on one line"));
  ::unlink(other_name.c_str());
}

TEST_F(SerialUnits, Of_one_gateway_need_one_framing) {
  std::vector<Map> maps(2);
  for (Map& map : maps) map.connection.address = "cell";
  maps[0].name = "left";
  maps[1].name = "right";
  maps[1].connection.framing = Framing::rtu;
  EXPECT_THAT(line_conflict(maps), HasSubstr("framing"));
  maps[0].connection.framing = Framing::rtu;
  EXPECT_THAT(line_conflict(maps), IsEmpty());
}

}  // namespace
}  // namespace coupler::host
