// SPDX-License-Identifier: Apache-2.0
// Many writes at a time are cancelled at one stroke.
#include "coupler/host/core/output_canceller.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <future>
#include <memory>

#include "test/host/core/schedule_fixture.hpp"

namespace coupler::host {
namespace {

using modbus::Exception;
using std::chrono::milliseconds;
using std::chrono::seconds;
using test::Became;
using test::TimedOutputsTest;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;
using Kind = modbus::Change::Kind;

struct OutputCancellerTest : TimedOutputsTest {
  /// Coils 5, 6 and 7, holding registers 2 and 3.
  static MapBuilder robot() {
    MapBuilder builder;
    builder.coil("left", 5).coil("middle", 6).coil("right", 7).holding("speed", 2).holding("force", 3);
    builder.head().connection.timeout = milliseconds(3000);
    return builder;
  }
  void begin_older_node() {
    begin_node(robot());
    device.refuses = [](const std::string& request) {
      return request.find('+') != std::string::npos && request.rfind("cancel", 0) == 0
                 ? std::optional(Exception::illegal_data_value)
                 : std::nullopt;
    };
  }
  std::future<CallAnswer> ask(const std::vector<std::string>& points, Duration from) {
    std::vector<std::uint32_t> indexes;
    for (const std::string& name : points) indexes.push_back(wanted(name, 0, seconds(0)).write.point);
    const auto answer = std::make_shared<std::promise<CallAnswer>>();
    engine->cancel_all({indexes, clock.now() + from},
                       [answer](const CallAnswer& given) { answer->set_value(given); });
    return answer->get_future();
  }
  CallAnswer cancel(const std::vector<std::string>& points, Duration from = seconds(0)) {
    auto answer = ask(points, from);
    engine->step();
    EXPECT_EQ(answer.wait_for(seconds(0)), std::future_status::ready);
    return answer.get();
  }
  /// The requests that cancel, since the last call.
  std::vector<std::string> requests() {
    std::vector<std::string> found;
    for (const std::string& request : device.requests)
      if (request.rfind("cancel", 0) == 0) found.push_back(request);
    device.requests.clear();
    return found;
  }
  std::vector<std::uint32_t> cancelled() const {
    std::vector<std::uint32_t> numbers;
    for (const ScheduledOutcome& one : sink->outcomes)
      if (one.result == Became::cancelled) numbers.push_back(one.number);
    std::sort(numbers.begin(), numbers.end());
    return numbers;
  }
  std::vector<std::uint32_t> waiting() const {
    std::vector<std::uint32_t> numbers;
    for (const WaitingWrite& one : engine->scheduled()) numbers.push_back(one.which.number);
    return numbers;
  }
};

TEST_F(OutputCancellerTest, One_request_cancels_all_of_a_table_at_the_node) {
  begin_node(robot());
  for (const char* point : {"right", "left", "middle", "left"}) schedule(point, 1, seconds(2));
  for (const char* point : {"force", "speed"}) schedule(point, 1, seconds(3));
  const CallAnswer answer = cancel({"left", "middle", "right", "speed", "force"});
  EXPECT_TRUE(answer.success);
  EXPECT_EQ(answer.text, "6 cancelled");
  EXPECT_THAT(requests(), ElementsAre("cancel coils 5+3", "cancel holding_registers 2+2"));
  ASSERT_EQ(device.cancels.size(), 2U);
  EXPECT_EQ(device.cancels[0].epoch, device.epoch);
  EXPECT_THAT(cancelled(), ElementsAre(1, 2, 3, 4, 5, 6));
  for (const ScheduledOutcome& one : sink->outcomes) EXPECT_EQ(one.reason, "its client cancelled it");
  EXPECT_FALSE(engine->has_to_end());
}

TEST_F(OutputCancellerTest, What_is_due_before_stays_as_the_node_counts_time) {
  begin_node(robot());
  for (int i = 1; i <= 4; ++i) schedule("left", 1, seconds(i));
  EXPECT_EQ(cancel({"left"}, milliseconds(2500)).text, "2 cancelled");
  EXPECT_THAT(requests(), ElementsAre("cancel coils 5+1"));
  ASSERT_EQ(device.cancels.size(), 1U);
  EXPECT_EQ(device.cancels[0].from, device.scheduled[2].due);
  EXPECT_THAT(cancelled(), ElementsAre(3, 4));
  EXPECT_THAT(waiting(), ElementsAre(1, 2));
}

TEST_F(OutputCancellerTest, A_write_of_another_point_between_them_stays) {
  begin_node(robot());
  for (const char* point : {"left", "middle", "right"}) schedule(point, 1, seconds(2));
  EXPECT_EQ(cancel({"left", "right"}).text, "2 cancelled");
  EXPECT_THAT(requests(), ElementsAre("cancel coils 5+1", "cancel coils 7+1"));
  EXPECT_THAT(waiting(), ElementsAre(2));
}

TEST_F(OutputCancellerTest, A_write_between_them_that_is_due_before_does_not_part_them) {
  begin_node(robot());
  schedule("middle", 1, seconds(1));
  for (const char* point : {"left", "right"}) schedule(point, 1, seconds(2));
  EXPECT_TRUE(cancel({"left", "right"}, milliseconds(1500)).success);
  EXPECT_THAT(requests(), ElementsAre("cancel coils 5+3"));
  EXPECT_THAT(waiting(), ElementsAre(1));
}

TEST_F(OutputCancellerTest, Without_a_write_that_waits_nothing_is_sent) {
  begin_node(robot());
  schedule("middle", 1, seconds(1));
  EXPECT_TRUE(cancel({"left"}).success);
  EXPECT_TRUE(cancel({"middle"}, seconds(2)).success);
  EXPECT_TRUE(cancel({}).success);
  EXPECT_THAT(requests(), IsEmpty());
}

TEST_F(OutputCancellerTest, An_older_node_is_asked_for_each_the_nearest_first) {
  begin_older_node();
  schedule("left", 1, seconds(3));
  schedule("right", 1, seconds(1));
  schedule("speed", 1, seconds(2));
  EXPECT_EQ(cancel({"left", "right", "speed"}).text, "3 cancelled");
  EXPECT_THAT(requests(), ElementsAre("cancel coils 5+3", "cancel 2", "cancel 3", "cancel 1"));
  EXPECT_THAT(cancelled(), ElementsAre(1, 2, 3));
}

TEST_F(OutputCancellerTest, That_a_node_is_older_is_known_until_the_connection_ends) {
  begin_older_node();
  schedule("left", 1, seconds(3));
  cancel({"left"});
  requests();
  schedule("left", 1, seconds(3));
  EXPECT_TRUE(cancel({"left"}).success);
  EXPECT_THAT(requests(), ElementsAre("cancel 2"));
  device.next_errors = {TransportFailure{"it has gone"}};
  run_for(seconds(5));
  device.refuses = nullptr;
  schedule("left", 1, seconds(3));
  requests();
  EXPECT_TRUE(cancel({"left"}).success);
  EXPECT_THAT(requests(), ElementsAre("cancel coils 5+1"));
}

TEST_F(OutputCancellerTest, What_an_older_node_has_begun_is_said) {
  begin_older_node();
  for (int i = 1; i <= 5; ++i) schedule("left", 1, seconds(i));
  device.refuses = [](const std::string& request) -> std::optional<Exception> {
    if (request == "cancel coils 5+1") return Exception::illegal_data_value;
    return request == "cancel 1" ? std::optional(Exception::illegal_data_address) : std::nullopt;
  };
  const CallAnswer answer = cancel({"left"});
  EXPECT_FALSE(answer.success);
  EXPECT_THAT(answer.text, StartsWith("too late for 1 of 5: they have begun"));
  EXPECT_THAT(waiting(), ElementsAre(1)) << "its outcome comes";
}

TEST_F(OutputCancellerTest, What_the_node_has_begun_is_said_and_the_others_are_cancelled) {
  begin_node(robot());
  schedule("left", 1, milliseconds(50));
  schedule("left", 0, seconds(2));
  clock.advance(milliseconds(100));
  const CallAnswer answer = cancel({"left"}, seconds(-1));
  EXPECT_FALSE(answer.success);
  EXPECT_THAT(answer.text, StartsWith("too late for 1 of 2: "));
  EXPECT_THAT(cancelled(), ElementsAre(2));
  device.decide(1, Kind::done);
  run_for(milliseconds(10));
  EXPECT_EQ(sink->outcomes.back().result, Became::done);
}

TEST_F(OutputCancellerTest, Where_the_number_of_them_does_not_say_which_the_changes_do) {
  begin_node(robot());
  for (int i = 1; i <= 3; ++i) schedule("left", 1, seconds(i));
  device.decided.insert(2);
  const CallAnswer answer = cancel({"left"});
  EXPECT_FALSE(answer.success);
  EXPECT_THAT(answer.text, StartsWith("too late for 1 of 3: "));
  EXPECT_THAT(sink->outcomes, IsEmpty());
  device.decide(1, Kind::cancelled, modbus::Reason::client);
  device.decide(2, Kind::cancelled, modbus::Reason::overwritten);
  device.decide(3, Kind::cancelled, modbus::Reason::client);
  run_for(milliseconds(10));
  EXPECT_THAT(cancelled(), ElementsAre(1, 2, 3));
}

TEST_F(OutputCancellerTest, In_a_new_epoch_the_node_has_cancelled_them_and_is_not_taken_for_an_older_one) {
  begin_node(robot());
  schedule("left", 1, seconds(3));
  ++device.epoch;
  device.refuses = [](const std::string& request) {
    return request == "cancel coils 5+1" ? std::optional(Exception::illegal_data_value) : std::nullopt;
  };
  cancel({"left"});
  EXPECT_THAT(cancelled(), ElementsAre(1));
  EXPECT_THAT(requests(), ElementsAre("cancel coils 5+1"));
  device.refuses = nullptr;
  run_for(milliseconds(10));
  schedule("left", 1, seconds(3));
  EXPECT_TRUE(cancel({"left"}).success);
  EXPECT_THAT(requests(), ElementsAre("cancel coils 5+1"));
}

TEST_F(OutputCancellerTest, Without_an_answer_of_the_node_it_is_in_doubt) {
  begin_node(robot());
  schedule("left", 1, seconds(3));
  schedule("speed", 1, seconds(3));
  device.refuses = [this](const std::string& request) -> std::optional<Exception> {
    if (request == "cancel holding_registers 2+1") device.next_errors = {TransportFailure{"it has gone"}};
    return std::nullopt;
  };
  const CallAnswer answer = cancel({"left", "speed"});
  EXPECT_FALSE(answer.success);
  EXPECT_THAT(answer.text, StartsWith("1 of 2 may or may not be carried out: "));
  ASSERT_EQ(sink->outcomes.size(), 2U);
  EXPECT_EQ(sink->outcomes[0].result, Became::cancelled);
  EXPECT_EQ(sink->outcomes[1].result, Became::unknown);
}

TEST_F(OutputCancellerTest, Those_of_the_drivers_own_timer_need_no_request) {
  begin_foreign(robot());
  for (int i = 1; i <= 3; ++i) schedule("left", 1, seconds(i));
  schedule("right", 1, seconds(3));
  EXPECT_EQ(cancel({"left"}, seconds(2)).text, "2 cancelled");
  EXPECT_THAT(cancelled(), ElementsAre(2, 3));
  EXPECT_THAT(waiting(), ElementsAre(1, 4));
  run_for(seconds(5));
  EXPECT_EQ(device.count("write coil 5"), 1U);
  EXPECT_EQ(device.count("write coil 7"), 1U);
}

TEST_F(OutputCancellerTest, One_that_the_driver_has_queued_is_withdrawn) {
  begin_foreign(robot());
  schedule("left", 1, milliseconds(50));
  clock.advance(milliseconds(50));
  EXPECT_TRUE(cancel({"left"}, seconds(-1)).success);
  EXPECT_THAT(cancelled(), ElementsAre(1));
  run_for(milliseconds(50));
  EXPECT_EQ(device.count("write coil 5"), 0U);
}

TEST_F(OutputCancellerTest, Calls_that_wait_are_refused_and_those_that_come_afterwards_are_not) {
  begin_node(robot());
  auto before = engine->schedule(wanted("left", 1, seconds(3)));
  auto earlier = engine->schedule(wanted("left", 1, seconds(1)));
  auto cancelling = ask({"left"}, seconds(2));
  auto after = engine->schedule(wanted("left", 1, seconds(3)));
  run_for(milliseconds(10));
  EXPECT_TRUE(cancelling.get().success);
  const ScheduleAnswer refused = before.get();
  EXPECT_EQ(refused.number, 0U);
  EXPECT_EQ(refused.text, "cancelled before it was accepted");
  EXPECT_NE(earlier.get().number, 0U);
  EXPECT_NE(after.get().number, 0U);
  EXPECT_EQ(device.scheduled.size(), 2U);
}

TEST_F(OutputCancellerTest, At_the_end_of_the_driver_one_request_cancels_all) {
  begin_node(robot());
  for (int i = 0; i < 64; ++i) schedule(i % 2 == 0 ? "left" : "right", 1, seconds(2 + i));
  EXPECT_EQ(waiting().size(), 64U);
  engine->stop();
  EXPECT_THAT(requests(), ElementsAre("cancel coils 5+3"));
  EXPECT_EQ(cancelled().size(), 64U);
  for (const ScheduledOutcome& one : sink->outcomes) EXPECT_EQ(one.reason, "the driver ends");
  EXPECT_FALSE(cancel({"left"}).success);
}

TEST_F(OutputCancellerTest, At_the_end_of_the_driver_the_outcome_of_what_has_begun_is_unknown) {
  begin_node(robot());
  schedule("left", 1, seconds(100));
  schedule("speed", 1, milliseconds(20));
  device.refuses = [](const std::string& request) {
    return request == "cancel coils 5+1" ? std::nullopt : std::optional(Exception::illegal_data_address);
  };
  engine->stop();
  ASSERT_EQ(sink->outcomes.size(), 2U);
  EXPECT_EQ(sink->outcomes[0].result, Became::cancelled);
  EXPECT_EQ(sink->outcomes[1].result, Became::unknown);
}

}  // namespace
}  // namespace coupler::host
