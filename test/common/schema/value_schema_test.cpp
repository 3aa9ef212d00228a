// SPDX-License-Identifier: Apache-2.0
// The patterns are those of ECMAScript, which std::regex knows.
#include "coupler/schema/value_schema.hpp"

#include <gtest/gtest.h>

#include <regex>

#include "coupler/codec/type_name.hpp"
#include "coupler/map/loader/names.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/network.hpp"

namespace coupler::schema {
namespace {

bool matches(const std::string& text, std::string_view pattern) {
  return std::regex_match(text, std::regex(std::string(pattern)));
}

TEST(Pattern, Of_names_takes_what_the_loader_takes) {
  for (const char* name : {"a", "A9_", "a/b", "a/9", "a/_", "", "9", "_a", "/a", "a/", "a//b", "a b", "ä"})
    EXPECT_EQ(matches(name, ros_name), loader::is_relative_ros_name(name)) << name;
}

TEST(Pattern, Of_durations_takes_what_the_loader_takes) {
  for (const char* text :
       {"1s", "500ms", "2.5min", "40us", ".5s", "1.s", "1", "s", "1 s", "-1s", "1h", "1..5s", ""})
    EXPECT_EQ(matches(text, duration), loader::parse_duration(text).has_value()) << text;
}

TEST(Pattern, Of_ip_addresses_takes_what_the_loader_takes_and_no_names) {
  for (const char* text : {"127.0.0.1", "::", "::1", "fd00::7", "fe80::7%eth0", "::ffff:10.0.0.7", "", "eth0",
                           "localhost", "127.0.0.1:1502", "[::1]", "10.0.0.0/8", "fe80::7%", "10.0.0.7%eth0"})
    EXPECT_EQ(matches(text, ip_address), is_ip_address(text)) << text;
}

TEST(Pattern, Of_words_takes_them_in_any_case) {
  const std::string pattern = any_case({"utf-8", "ascii"});
  for (const char* good : {"utf-8", "UTF_8", "utf8", "Ascii"}) EXPECT_TRUE(matches(good, pattern)) << good;
  for (const char* bad : {"utf", "utf-88", "asci", ""}) EXPECT_FALSE(matches(bad, pattern)) << bad;
}

TEST(Pattern, Of_types_takes_every_name_that_the_loader_takes) {
  std::vector<std::string_view> all;
  for (const auto& type : enumeration_of<codec::Type>.words) all.push_back(type.word);
  const std::string pattern = any_name(all);
  for (const codec::TypeName& other : codec::other_type_names())
    EXPECT_TRUE(matches(std::string(other.name), pattern)) << other.name;
  for (const char* good : {"UINT", "uint", "UInt16", "float-32", "Unsigned 16", "uint8_t"})
    EXPECT_TRUE(matches(good, pattern)) << good;
  for (const codec::AmbiguousTypeName& each : codec::ambiguous_type_names())
    EXPECT_FALSE(matches(std::string(each.name), pattern)) << each.name;
  for (const char* bad : {"", "int24", "uint 1 6", "UNIT"}) EXPECT_FALSE(matches(bad, pattern)) << bad;
  EXPECT_FALSE(matches("float32", any_name({"LREAL", "STRING"})));
}

}  // namespace
}  // namespace coupler::schema
