// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <utility>

#include "coupler/device/node/node_runtime.hpp"
#include "test/device/core/fake_log.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::device {
namespace {

using codec::Type;
using fakes::MapBuilder;
using modbus::Range;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

Options simulated() {
  Options options;
  options.simulated = true;
  options.port = 0;
  return options;
}

/// Until the log tells that the map is refused, or change() is to be called: then true.
bool reload_ends(NodeRuntime& runtime, Loop& loop, const FakeLog& log) {
  const std::size_t told = log.lines.size();
  while (log.lines.size() == told)
    if (runtime.look_after(loop.run_once(std::chrono::milliseconds(10)))) return true;
  return false;
}

/// A simulated node with lamp and speed, and a map that it reads at the next reload.
class Simulated : public testing::Test {
 protected:
  Simulated() { EXPECT_TRUE(runtime_.start(first_->map(), {}).has_value()); }

  static MapBuilder plant() {
    MapBuilder builder("plant");
    builder.add(Table::coils, "lamp", 0, Type::BOOL).add(Table::holding_registers, "speed", 0, Type::INT);
    return builder;
  }
  /// Whether the runtime has another map then.
  bool is_taken() {
    runtime_.reload(0);
    return reload_ends(runtime_, loop_, log_);
  }
  /// What is left of one client.
  std::size_t reload() {
    EXPECT_TRUE(is_taken());
    std::vector<OpenConnection> clients(1);
    runtime_.change(clients);
    return clients.size();
  }

  MapPtr first_ = plant().build();
  MapPtr next_;
  Options options_ = simulated();
  FakeLog log_;
  ServiceManager nobody_{nullptr, nullptr};
  Loop loop_;
  NodeRuntime runtime_{loop_, options_, {[this] { return next_; }}, nobody_, log_};
};

TEST_F(Simulated, It_says_that_it_serves_once_it_does) {
  EXPECT_THAT(log_.lines, Not(Contains(HasSubstr("serving"))));
  runtime_.beat();
  runtime_.beat();
  EXPECT_THAT(log_.lines, ElementsAre(HasSubstr("serving plant (2 points")));
}

TEST_F(Simulated, A_map_that_looks_the_same_keeps_the_clients) {
  next_ = plant().build();
  EXPECT_EQ(reload(), 1U);
  EXPECT_THAT(log_.lines, Contains(HasSubstr("read the map again: serving plant (2 points")));
}

TEST_F(Simulated, Another_map_sends_them_away) {
  next_ = plant().add(Table::coils, "horn", 1, Type::BOOL).build();
  EXPECT_EQ(reload(), 0U);
  EXPECT_THAT(log_.lines, Contains(HasSubstr("clients have to connect again")));
}

TEST_F(Simulated, Another_unit_id_too) {
  next_ = plant().unit(7).build();
  EXPECT_EQ(reload(), 0U);
}

TEST_F(Simulated, A_map_that_cannot_be_read_is_refused) {
  EXPECT_FALSE(is_taken());
  EXPECT_THAT(log_.lines,
              Contains(HasSubstr("the new map is refused; the old one stays in force: serving plant")));
}

TEST_F(Simulated, A_map_that_no_node_can_serve_is_refused) {
  next_ = plant().add(Table::input_registers, "high", 0xFF00, Type::INT).build();
  EXPECT_FALSE(is_taken());
  EXPECT_THAT(log_.lines, Contains(HasSubstr("point 'high'")));
}

TEST_F(Simulated, An_address_that_is_not_this_machines_is_refused) {
  options_.listen = "192.0.2.1";
  next_ = plant().build();
  EXPECT_FALSE(is_taken());
  EXPECT_THAT(log_.lines, Contains(HasSubstr("cannot listen on 192.0.2.1")));
}

TEST(OnItsBoard, Lines_that_cannot_be_had_are_refused) {
  Options options = simulated();
  options.simulated = false;
  options.listen = "127.0.0.1";
  FakeLog log;
  ServiceManager nobody(nullptr, nullptr);
  const MapPtr first = MapBuilder().many(Table::coils, 0, 1).build();
  const MapPtr next =
      MapBuilder()
          .add(Table::coils, "horn", 1, Type::BOOL, [](Point& p) { p.line.chip = "no-such-chip"; })
          .build();
  Loop loop;
  NodeRuntime runtime(loop, options, {[&] { return next; }}, nobody, log);
  ASSERT_TRUE(runtime.start(first->map(), {}).has_value());
  runtime.reload(0);
  EXPECT_FALSE(reload_ends(runtime, loop, log));
  EXPECT_THAT(log.lines, Contains(HasSubstr("point 'horn'")));
}

TEST(BuiltIn, A_node_without_a_file_ignores_the_wish_to_reload) {
  const Options options = simulated();
  FakeLog log;
  ServiceManager nobody(nullptr, nullptr);
  Loop loop;
  NodeRuntime runtime(loop, options, {}, nobody, log);
  const MapPtr map = MapBuilder().many(Table::coils, 0, 1).build();
  ASSERT_TRUE(runtime.start(map->map(), {}).has_value());
  runtime.reload(0);
  EXPECT_THAT(log.lines.back(), HasSubstr("built in"));
}

}  // namespace
}  // namespace coupler::device
