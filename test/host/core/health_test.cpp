// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/health.hpp"
#include "test/fakes/map_builder.hpp"

#include <gmock/gmock.h>

namespace coupler::host {
namespace {

using testing::HasSubstr;
using State = PointQuality::State;
using Outcome = WriteResult::Outcome;

struct HealthTest : testing::Test {
  HealthTest() { now.online = true; }
  Health polling(std::vector<State> states) {
    std::vector<PointQuality> points;
    for (const State state : states) points.push_back({state, {}, {}});
    return polling_health(owned->map(), points, before, now);
  }
  std::uint64_t& wrote(Outcome outcome) { return now.writes[static_cast<std::size_t>(outcome)]; }

  MapPtr owned = fakes::MapBuilder().holding("a", 0).holding("b", 1).holding("c", 2).build();
  DeviceSnapshot before;
  DeviceSnapshot now;
};

TEST_F(HealthTest, Offline_is_an_error_with_its_reason) {
  now.online = false;
  now.trouble = "no reply within 500 ms";
  EXPECT_EQ(connection_health(now).level, Level::error);
  EXPECT_THAT(connection_health(now).text, HasSubstr("no reply within 500 ms"));
}

TEST_F(HealthTest, Another_map_is_a_warning_while_online) {
  now.identity = Identity::Verdict::equal;
  EXPECT_EQ(connection_health(now).level, Level::info);
  now.identity = Identity::Verdict::different;
  EXPECT_EQ(connection_health(now).level, Level::warning);
}

TEST_F(HealthTest, Points_without_a_value_are_named) {
  EXPECT_EQ(polling({State::good, State::good, State::good}).level, Level::info);
  const Health some = polling({State::good, State::rejected, State::stale});
  EXPECT_EQ(some.level, Level::warning);
  EXPECT_EQ(some.text, "no value of b (rejected), c (stale)");
}

TEST_F(HealthTest, No_value_at_all_is_an_error) {
  EXPECT_EQ(polling({State::exception, State::rejected, State::stale}).level, Level::error);
}

TEST_F(HealthTest, What_nobody_has_read_yet_or_wants_to_is_no_trouble) {
  EXPECT_EQ(polling({State::good, State::never_read, State::not_wanted}).level, Level::info);
}

TEST_F(HealthTest, Cycles_that_were_left_out_are_a_warning_while_they_happen) {
  now.overruns = 3;
  EXPECT_THAT(polling({State::good, State::good, State::good}).text, HasSubstr("3 cycles left out"));
  before.overruns = 3;
  EXPECT_EQ(polling({State::good, State::good, State::good}).level, Level::info);
}

TEST_F(HealthTest, Writes_that_did_not_arrive_are_a_warning_while_they_happen) {
  wrote(Outcome::ok) = 7;
  wrote(Outcome::superseded) = 2;
  EXPECT_EQ(writes_health(before, now).level, Level::info);
  wrote(Outcome::lost) = 1;
  EXPECT_EQ(writes_health(before, now).level, Level::warning);
  EXPECT_THAT(writes_health(before, now).text, HasSubstr("1 lost"));
  before = now;
  EXPECT_EQ(writes_health(before, now).level, Level::info);
}

TEST_F(HealthTest, A_certificate_that_ends_soon_is_a_warning_and_one_that_has_ended_an_error) {
  const std::chrono::system_clock::time_point today{std::chrono::seconds(1'795'651'200)};  // 2026-11-26
  constexpr std::chrono::hours day(24);
  EXPECT_EQ(certificates_health(now.certificates, today).text, "not connected yet");

  now.certificates = {{"cell1", "operator", {today - day, today + 700 * day}},
                      {"press", {}, {today, today + 90 * day}}};
  EXPECT_EQ(certificates_health(now.certificates, today).level, Level::info);
  EXPECT_EQ(certificates_health(now.certificates, today).text, "good until 2027-02-24 00:00 UTC");

  const Health soon = certificates_health(now.certificates, today + 60 * day);
  EXPECT_EQ(soon.level, Level::warning);
  EXPECT_EQ(soon.text,
            "the device's certificate expires on 2027-02-24 00:00 UTC; renew it ('coupler certificates')");
  now.certificates->own.validity.end = today + 59 * day;
  const Health late = certificates_health(now.certificates, today + 60 * day);
  EXPECT_EQ(late.level, Level::error);
  EXPECT_THAT(late.text, HasSubstr("this machine's certificate has expired on 2027-01-24"));
  EXPECT_THAT(late.text, HasSubstr("; the device's certificate expires on"));

  now.certificates->has_pin = true;  // it is believed beyond its end
  EXPECT_THAT(certificates_health(now.certificates, today + 60 * day).text,
              testing::Not(HasSubstr("the device's")));
}

TEST_F(HealthTest, Values_that_are_none_are_a_warning_because_the_device_answers) {
  const Health health = polling({State::invalid, State::invalid, State::never_read});
  EXPECT_EQ(health.level, Level::warning);
  EXPECT_EQ(health.text, "no value of a (invalid), b (invalid)");
}

}  // namespace
}  // namespace coupler::host
