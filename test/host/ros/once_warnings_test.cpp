// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/once_warnings.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace coupler::host {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Finding finding(const std::string& key, bool is_sure = true) {
  return {key, [key] { return "wrong: " + key; }, is_sure};
}

std::vector<Finding> findings(std::size_t count, bool is_sure = true) {
  std::vector<Finding> made;
  for (std::size_t i = 0; i < count; ++i) made.push_back(finding(std::to_string(i), is_sure));
  return made;
}

TEST(OnceWarnings, Each_is_said_once_as_long_as_it_is_there) {
  OnceWarnings warnings;
  EXPECT_THAT(warnings.update({finding("a")}, "things"), ElementsAre("wrong: a"));
  EXPECT_THAT(warnings.update({finding("a"), finding("b")}, "things"), ElementsAre("wrong: b"));
  EXPECT_THAT(warnings.update({finding("b")}, "things"), IsEmpty());
  EXPECT_THAT(warnings.update({finding("b"), finding("a")}, "things"), ElementsAre("wrong: a"))
      << "it was gone meanwhile";
}

TEST(OnceWarnings, Two_of_one_key_are_one) {
  OnceWarnings warnings;
  EXPECT_THAT(warnings.update({finding("a"), finding("a")}, "things"), ElementsAre("wrong: a"));
}

TEST(OnceWarnings, What_has_no_text_is_not_said_and_not_asked_again) {
  OnceWarnings warnings;
  int asked = 0;
  const Finding silent{"a", [&asked] { return ++asked, std::string(); }, false};
  EXPECT_THAT(warnings.update({silent}, "things"), IsEmpty());
  EXPECT_THAT(warnings.update({silent}, "things"), IsEmpty());
  EXPECT_EQ(asked, 1);
}

TEST(OnceWarnings, More_than_twenty_at_once_are_counted_and_not_said_later) {
  OnceWarnings warnings;
  const auto lines = warnings.update(findings(65), "things");
  ASSERT_EQ(lines.size(), OnceWarnings::most_at_once + 1);
  EXPECT_EQ(lines.back(), "and 45 more things");
  EXPECT_THAT(warnings.update(findings(65), "things"), IsEmpty());
}

TEST(OnceWarnings, What_is_not_sure_is_not_counted) {
  OnceWarnings warnings;
  EXPECT_EQ(warnings.update(findings(65, false), "things").size(), OnceWarnings::most_at_once);
  EXPECT_EQ(warnings.update(findings(65, false), "things").size(), OnceWarnings::most_at_once)
      << "the next twenty";
}

}  // namespace
}  // namespace coupler::host
