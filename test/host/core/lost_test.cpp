// SPDX-License-Identifier: Apache-2.0
// A connection that ends while those who are told of it throw.
#include <gmock/gmock.h>

#include <array>
#include <new>

#include "test/fakes/map_builder.hpp"
#include "test/host/core/device_fixture.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;
using testing::SizeIs;
using Outcome = WriteResult::Outcome;

struct ThrowingListener : WriteListener {
  std::vector<Outcome> outcomes;
  void on_result(const WriteResult& result) override {
    outcomes.push_back(result.outcome);
    throw std::bad_alloc();
  }
};

struct LostTest : test::DeviceTest {
  LostTest() { start(MapBuilder().holding("a", 0).holding("b", 5).holding("c", 9), Verify::off); }
};

TEST_F(LostTest, All_are_told_though_some_of_them_throw_and_that_is_reported_once) {
  run_for(milliseconds(50));
  ScheduledWrite what;
  what.write.point = 2;
  what.due = clock.now() + std::chrono::seconds(1);
  auto accepted = engine->schedule(what);
  run_for(milliseconds(10));
  ASSERT_GT(accepted.get().number, 0U);
  ASSERT_THAT(sink->online, testing::ElementsAre(true));

  std::array<ThrowingListener, 3> throwing;
  push("a", 1, &throwing[0]);
  push("b", 1, &throwing[1]);
  push("c", 1, &throwing[2]);
  device.next_errors.push_back(TransportFailure{"reset"});
  EXPECT_NO_THROW(run_for(milliseconds(20)));
  for (const ThrowingListener& each : throwing) EXPECT_THAT(each.outcomes, SizeIs(1));
  EXPECT_THAT(sink->online, testing::ElementsAre(true, false));
  ASSERT_THAT(sink->outcomes, SizeIs(1));
  EXPECT_EQ(sink->outcomes[0].result, ScheduledOutcome::Result::cancelled);
  EXPECT_EQ(sink->reported("connection lost: "), 1);
  EXPECT_EQ(sink->reported("std::bad_alloc"), 1);

  run_for(std::chrono::seconds(3));
  EXPECT_THAT(sink->online, testing::ElementsAre(true, false, true));
  EXPECT_THAT(sink->outcomes, SizeIs(1));
}

}  // namespace
}  // namespace coupler::host
