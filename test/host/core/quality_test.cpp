// SPDX-License-Identifier: Apache-2.0
// What the driver says of points and device, seen from outside.
#include <gmock/gmock.h>

#include "test/host/core/device_fixture.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;
using test::DeviceTest;
using State = PointQuality::State;

struct QualityTest : DeviceTest {
  PointQuality quality(std::string_view point) const {
    return table->quality(static_cast<std::uint32_t>(find(owned->map(), point) - owned->map().points.begin()),
                          clock.now());
  }
};

TEST_F(QualityTest, A_point_that_was_read_is_good_and_has_an_age) {
  start(MapBuilder().holding("a", 5));
  EXPECT_EQ(quality("a").state, State::offline);
  run_for(milliseconds(50));
  EXPECT_EQ(quality("a").state, State::good);
  EXPECT_EQ(clock.now() - *quality("a").last_good, milliseconds(50));
}

TEST_F(QualityTest, A_point_that_answers_an_exception_says_which_and_keeps_its_age) {
  start(MapBuilder().holding("a", 5));
  run_for(milliseconds(50));
  device.next_errors.push_back(ExceptionReply{modbus::Exception::server_device_busy});
  run_for(milliseconds(100));
  EXPECT_EQ(quality("a").state, State::exception);
  EXPECT_EQ(quality("a").last_exception, modbus::Exception::server_device_busy);
  EXPECT_EQ(clock.now() - *quality("a").last_good, milliseconds(150));
  run_for(milliseconds(100));
  EXPECT_EQ(quality("a").state, State::good);
  EXPECT_EQ(quality("a").last_exception, modbus::Exception::server_device_busy) << "the last one there was";
}

TEST_F(QualityTest, A_point_that_the_device_does_not_have_is_rejected) {
  device.missing.insert({Table::holding_registers, 6});
  start(MapBuilder().holding("a", 5).holding("b", 6));
  run_for(milliseconds(50));
  EXPECT_EQ(quality("a").state, State::good);
  EXPECT_EQ(quality("b").state, State::rejected);
  EXPECT_GE(engine->statistics().rejected_ranges, 1U);
}

TEST_F(QualityTest, There_is_another_revision_when_something_else_is_to_be_told) {
  start(MapBuilder().holding("a", 5).holding("b", 6));
  run_for(milliseconds(50));
  std::uint64_t revision = engine->revision();
  const auto is_another = [&] { return engine->revision() != std::exchange(revision, engine->revision()); };
  run_for(milliseconds(1000));
  EXPECT_FALSE(is_another()) << "good remains good";
  device.next_errors.push_back(ExceptionReply{modbus::Exception::server_device_busy});
  run_for(milliseconds(100));
  EXPECT_TRUE(is_another()) << "an exception";
  run_for(milliseconds(100));
  EXPECT_TRUE(is_another()) << "it is good again";
  device.next_errors.push_back(TransportFailure{"reset"});
  run_for(milliseconds(100));
  EXPECT_TRUE(is_another()) << "the connection is lost";
}

TEST_F(QualityTest, A_good_point_says_from_when_on_it_will_be_stale) {
  start(MapBuilder().holding("a", 5));
  run_for(milliseconds(50));
  const Time stale_from = quality("a").stale_from;
  EXPECT_GT(stale_from, clock.now());
  engine->want(0, false);
  clock.sleep_until(stale_from);
  EXPECT_EQ(quality("a").state, State::good);
  clock.advance(milliseconds(1));
  EXPECT_EQ(quality("a").state, State::stale);
}

TEST_F(QualityTest, While_the_link_is_down_every_point_is_offline) {
  start(MapBuilder().holding("a", 5));
  run_for(milliseconds(50));
  device.refuse_connect = NotConnected{"refused"};
  device.next_errors.push_back(TransportFailure{"reset"});
  run_for(milliseconds(300));
  EXPECT_EQ(quality("a").state, State::offline);
  EXPECT_FALSE(engine->statistics().online);
  EXPECT_EQ(engine->statistics().trouble, "refused");
}

TEST_F(QualityTest, A_point_that_nobody_asks_for_any_more_grows_stale) {
  start(MapBuilder().holding("a", 5).holding("b", 50));
  run_for(milliseconds(50));
  engine->want(0, false);
  run_for(milliseconds(3100));
  EXPECT_EQ(quality("a").state, State::good);
  run_for(milliseconds(200));
  EXPECT_EQ(quality("a").state, State::stale);
  EXPECT_EQ(quality("b").state, State::good);
}

TEST_F(QualityTest, A_connection_that_has_been_idle_for_a_timeout_is_probed) {
  MapBuilder builder;
  builder.command("a", 5);
  start(builder);
  run_for(milliseconds(100));
  device.requests.clear();
  device.next_errors.push_back(Timeout{milliseconds(3000)});
  run_for(milliseconds(2800));
  EXPECT_TRUE(device.requests.empty());
  run_for(milliseconds(110));
  EXPECT_EQ(device.requests.front(), "read coils 5+1");
  EXPECT_THAT(sink->online, testing::ElementsAre(true, false));
}

TEST_F(QualityTest, Requests_answers_and_connections_are_counted) {
  start(MapBuilder().holding("a", 5), Verify::off);
  device.reply_time = milliseconds(4);
  run_for(milliseconds(950));
  device.next_errors.push_back(ExceptionReply{modbus::Exception::server_device_busy});
  device.next_errors.push_back(Timeout{milliseconds(3000)});
  run_for(milliseconds(500));
  const DeviceSnapshot seen = engine->statistics();
  EXPECT_EQ(seen.exceptions[6], 1U);
  EXPECT_EQ(seen.timeouts, 1U);
  EXPECT_EQ(seen.connections, 2U);
  EXPECT_EQ(seen.requests, seen.latency.count() + 1);
  EXPECT_GE(seen.latency.quantile(0.5), milliseconds(4));
  EXPECT_LE(seen.latency.quantile(0.99), milliseconds(5));
}

TEST_F(QualityTest, The_verdict_on_the_identity_is_told) {
  MapBuilder builder;
  builder.holding("a", 5);
  serve(builder);
  start(builder);
  run_for(milliseconds(50));
  EXPECT_EQ(engine->statistics().identity, Identity::Verdict::equal);
}

}  // namespace
}  // namespace coupler::host
