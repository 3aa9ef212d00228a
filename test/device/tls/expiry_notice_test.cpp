// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupler/device/tls/expiry_notice.hpp"
#include "test/device/core/fake_log.hpp"

namespace coupler::device {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Optional;

TEST(ExpiryNotice, Tells_it_once_a_day_from_when_it_is_time) {
  const ExpiryNotice::WallTime start{};
  FakeLog log;
  ExpiryNotice notice(log);
  TimePoint now{hours(5)};
  EXPECT_EQ(notice.time_until_due(now), std::nullopt);
  notice.tick(now, start);

  notice.watch({start, start + hours(30)});  // from hour 20 on
  EXPECT_THAT(notice.time_until_due(now), Optional(milliseconds(0)));
  notice.tick(now, start + hours(19));
  EXPECT_THAT(log.lines, IsEmpty());
  EXPECT_THAT(notice.time_until_due(now), Optional(milliseconds(hours(1))));
  notice.tick(now += hours(1), start + hours(20));
  EXPECT_THAT(log.lines, ElementsAre(HasSubstr("the node's certificate expires on")));
  notice.tick(now += hours(23), start + hours(43));
  EXPECT_THAT(log.lines, testing::SizeIs(1));
  notice.tick(now += hours(1), start + hours(44));
  EXPECT_THAT(log.lines, ElementsAre(HasSubstr("expires on"), HasSubstr("has expired on")));

  notice.watch({start + hours(44), start + hours(1000)});  // renewed
  notice.tick(now, start + hours(44));
  EXPECT_THAT(log.lines, testing::SizeIs(2));
}

}  // namespace
}  // namespace coupler::device
