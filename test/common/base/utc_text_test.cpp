// SPDX-License-Identifier: Apache-2.0
#include "coupler/base/utc_text.hpp"

#include <gtest/gtest.h>

namespace coupler {
namespace {

std::string utc_of(std::chrono::microseconds since_1970) {
  return utc_text(std::chrono::system_clock::time_point(since_1970));
}

TEST(UtcText, Is_ISO_8601_with_milliseconds) {
  EXPECT_EQ(utc_of(std::chrono::microseconds(1795267211123000)), "2026-11-21T13:20:11.123Z");
  EXPECT_EQ(utc_of({}), "1970-01-01T00:00:00.000Z");
}

TEST(UtcText, Is_rounded_down_also_before_1970) {
  EXPECT_EQ(utc_of(std::chrono::microseconds(1795267211999999)), "2026-11-21T13:20:11.999Z");
  EXPECT_EQ(utc_of(std::chrono::microseconds(-1)), "1969-12-31T23:59:59.999Z");
}

}  // namespace
}  // namespace coupler
