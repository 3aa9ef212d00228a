// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/replay/replay_time.hpp"

#include <cstdlib>
#include <ctime>

#include <gtest/gtest.h>

namespace coupler::device {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::nanoseconds;
using std::chrono::seconds;
using Moment = std::optional<nanoseconds>;

/// On a machine in Central Europe: an hour ahead in winter, two in summer.
class ReplayTime : public testing::Test {
 protected:
  ReplayTime() {
    if (const char* zone = std::getenv("TZ")) before_ = zone;
    set_zone("CET-1CEST,M3.5.0,M10.5.0/3");
  }
  ~ReplayTime() override {
    if (before_)
      set_zone(before_->c_str());
    else
      ::unsetenv("TZ");
    ::tzset();
  }
  static void set_zone(const char* zone) {
    ::setenv("TZ", zone, 1);
    ::tzset();
  }

  /// 2026-11-24T15:00:00Z
  static constexpr nanoseconds three = seconds(1795532400);
  /// In a recording that began then, and a bit.
  static Moment parse(const std::string& text) { return parse_moment(text, three + milliseconds(123)); }

 private:
  std::optional<std::string> before_;
};

TEST_F(ReplayTime, With_a_Z_is_UTC) {
  EXPECT_EQ(parse("2026-11-24T15:00:00Z"), three);
  EXPECT_EQ(parse("2026-11-24T15:01Z"), three + minutes(1));
  EXPECT_EQ(parse("2026-07-24T15:00:00Z"), seconds(1784905200)) << "in summer, too";
}

TEST_F(ReplayTime, Without_a_Z_is_local_time) {
  EXPECT_EQ(parse("2026-11-24T16:00:00"), three);
  EXPECT_EQ(parse("2026-11-24T16:01"), three + minutes(1));
  EXPECT_EQ(parse("2026-07-24T17:00:00"), seconds(1784905200)) << "in summer";
}

TEST_F(ReplayTime, Of_the_day_is_that_of_the_first_day) {
  EXPECT_EQ(parse("16:00"), three);
  EXPECT_EQ(parse("16:00:12"), three + seconds(12));
  EXPECT_EQ(parse("00:00"), three - hours(16));
  EXPECT_EQ(parse("15:00Z"), three);
}

TEST_F(ReplayTime, The_first_day_is_a_local_one) {
  const nanoseconds just_after_midnight = three + hours(8) + minutes(30);
  EXPECT_EQ(parse_moment("01:00", just_after_midnight), three + hours(9));
  EXPECT_EQ(parse_moment("01:00Z", just_after_midnight), three - hours(14));
}

TEST_F(ReplayTime, Seconds_may_have_a_fraction) {
  EXPECT_EQ(parse("16:00:12.5"), three + milliseconds(12500));
  EXPECT_EQ(parse("2026-11-24T15:00:00.25Z"), three + milliseconds(250));
  EXPECT_EQ(parse("2026-11-24T16:00:00.125"), three + milliseconds(125));
}

TEST_F(ReplayTime, What_is_none_is_none) {
  for (const char* text : {"",
                           "Z",
                           "noon",
                           "16",
                           "16:",
                           "16:60",
                           "24:00",
                           "16:00:62",
                           "16:00 ",
                           "16:00x",
                           "16:00:00.",
                           "16:00:00.5s",
                           "16:00:00,5",
                           "16:00:00.-5",
                           "16:00:00ZZ",
                           "2026-11-24",
                           "2026-11-24 16:00",
                           "2026-13-24T16:00",
                           "2026-11-24T16:00:00+01:00",
                           "-16:00",
                           "1795532400"})
    EXPECT_EQ(parse(text), std::nullopt) << text;
}

}  // namespace
}  // namespace coupler::device
