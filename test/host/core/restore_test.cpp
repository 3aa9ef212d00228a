// SPDX-License-Identifier: Apache-2.0
// Outputs that are not restored because a newer value waits, and what becomes of them if it is not written.
#include <gmock/gmock.h>

#include <functional>
#include <utility>

#include "test/fakes/map_builder.hpp"
#include "test/host/core/device_fixture.hpp"

namespace coupler::host {
namespace {

using codec::Type;
using std::chrono::milliseconds;
using testing::ElementsAre;
using Outcome = WriteResult::Outcome;

constexpr std::uint16_t stopped[] = {0};

struct RestoreTest : test::DeviceTest, WriteListener {
  std::vector<Outcome> outcomes;
  void on_result(const WriteResult& result) override { outcomes.push_back(result.outcome); }

  /// The register `speed` had 5 when the device went away, and forgot it. It is back, and while it is asked
  /// who it is, `meanwhile` happens.
  void come_back(const std::function<void()>& meanwhile,
                 const std::function<void(Point&)>& adjust = nullptr) {
    fakes::MapBuilder builder;
    builder.add(Table::holding_registers, "speed", 5, Type::UINT, [&](Point& point) {
      if (adjust) adjust(point);
    });
    builder.head().on_reconnect = OnReconnect::restore;
    owned = builder.build();
    make_sink();
    make_engine(Verify::require, nullptr);
    run_for(milliseconds(50));
    push("speed", 5);
    engine->step();
    ASSERT_EQ(speed(), 5);
    device.next_errors.push_back(TransportFailure{"reset"});
    run_for(milliseconds(99));
    device.values.clear();
    device.requests.clear();
    bool has_happened = false;
    device.during_read = [&] {
      if (!std::exchange(has_happened, true)) meanwhile();
    };
    run_for(milliseconds(500));
    device.during_read = nullptr;
    ASSERT_TRUE(has_happened) << "it was not asked";
  }
  void push_until(std::uint16_t value, Time until) {
    Write write;
    write.registers[0] = value;
    write.until = until;
    write.listener = this;
    engine->push(write);
  }
  void refuse_writes(std::size_t count) {
    device.refuses = [this, count](const std::string& request) mutable -> std::optional<modbus::Exception> {
      if (count == 0 || request != "write register 5") return std::nullopt;
      --count;
      return modbus::Exception::illegal_data_value;
    };
  }
  std::uint16_t speed() { return device.values[{Table::holding_registers, 5}]; }
  std::size_t writes() const { return device.count("write register 5"); }
};

TEST_F(RestoreTest, While_a_newer_value_waits_the_older_one_is_not_written) {
  come_back([this] { push("speed", 7, this); });
  EXPECT_THAT(outcomes, ElementsAre(Outcome::ok));
  EXPECT_EQ(speed(), 7);
  EXPECT_EQ(writes(), 1U);
}

TEST_F(RestoreTest, It_is_restored_once_if_that_value_comes_too_late) {
  come_back([this] {
    push_until(7, clock.now() + milliseconds(10));
    clock.advance(milliseconds(20));
  });
  EXPECT_THAT(outcomes, ElementsAre(Outcome::dropped));
  EXPECT_EQ(speed(), 5);
  EXPECT_EQ(writes(), 1U);
  EXPECT_EQ(sink->reported("1 outputs were restored"), 1);
}

TEST_F(RestoreTest, It_is_restored_once_if_that_value_is_refused) {
  come_back([this] {
    push("speed", 7, this);
    refuse_writes(1);
  });
  EXPECT_THAT(outcomes, ElementsAre(Outcome::exception));
  EXPECT_EQ(speed(), 5);
  EXPECT_EQ(writes(), 2U);
}

TEST_F(RestoreTest, It_is_not_restored_if_one_of_the_values_that_wait_is_written) {
  come_back([this] {
    push_until(7, clock.now() + milliseconds(10));
    Write last;
    last.registers[0] = 8;
    last.ordered = true;
    last.listener = this;
    engine->push(last);
    clock.advance(milliseconds(20));
  });
  EXPECT_THAT(outcomes, ElementsAre(Outcome::dropped, Outcome::ok));
  EXPECT_EQ(speed(), 8);
  EXPECT_EQ(writes(), 1U);
}

TEST_F(RestoreTest, It_is_not_tried_again_and_again) {
  come_back([this] {
    push("speed", 7, this);
    refuse_writes(10);
  });
  EXPECT_EQ(writes(), 2U);
  EXPECT_EQ(sink->reported("speed was not restored"), 1);
}

TEST_F(RestoreTest, What_a_deadman_ended_is_not_restored_though_its_value_is_refused) {
  come_back(
      [this] {
        clock.advance(milliseconds(300));
        refuse_writes(1);
      },
      [](Point& point) {
        point.host.deadman = {milliseconds(200), stopped};
      });
  EXPECT_EQ(speed(), 0);
  EXPECT_EQ(writes(), 1U);
}

}  // namespace
}  // namespace coupler::host
