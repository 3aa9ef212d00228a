// SPDX-License-Identifier: Apache-2.0
// The patterns are those of ECMAScript, which std::regex knows.
#include "coupler/tools/schema/value_schema.hpp"

#include <gtest/gtest.h>

#include <map>
#include <regex>

#include "coupler/codec/type_name.hpp"
#include "coupler/map/loader/names.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/network.hpp"

namespace coupler::schema {
namespace {

bool matches(const std::string& text, std::string_view pattern) {
  static std::map<std::string, std::regex> compiled;
  const auto found = compiled.try_emplace(std::string(pattern), std::string(pattern)).first;
  return std::regex_match(text, found->second);
}

TEST(Pattern, Of_names_takes_what_the_loader_takes) {
  for (const char* name : {"a", "A9_", "a/b", "a/9", "a/_", "", "9", "_a", "/a", "a/", "a//b", "a b", "ä"})
    EXPECT_EQ(matches(name, ros_name), loader::is_relative_ros_name(name)) << name;
}

TEST(Pattern, Of_durations_takes_what_the_loader_takes) {
  const std::vector<std::string> forms{"1s",  "500ms", "2.5min", "40us",  ".5s", "1.s", "1",     "s",
                                       "1 s", "-1s",   "1h",     "1..5s", "",    ".s",  "0001s", "1s "};
  for (const std::string& text : forms)
    EXPECT_EQ(matches(text, duration_up_to(3600)), loader::parse_duration(text).has_value()) << text;
}

TEST(Pattern, Of_durations_knows_the_longest) {
  const std::vector<std::string> within{"3600s",        "3600.0s", "03600s",    "3599.999s",
                                        "60min",        "59.9min", "3600000ms", "3599999.9ms",
                                        "3600000000us", "999us",   "0s"};
  const std::vector<std::string> beyond{"3601s",    "3600.1s",   "4000s",        "10000s",       "61min",
                                        "60.01min", "3600001ms", "3600000001us", "99999999999us"};
  for (const std::string& text : within) EXPECT_TRUE(matches(text, duration_up_to(3600))) << text;
  for (const std::string& text : beyond) EXPECT_FALSE(matches(text, duration_up_to(3600))) << text;
  EXPECT_TRUE(matches("60s", duration_up_to(60)));
  EXPECT_FALSE(matches("60.5s", duration_up_to(60)));
  EXPECT_TRUE(matches("1min", duration_up_to(60)));
  EXPECT_FALSE(matches("1.5min", duration_up_to(60)));
  EXPECT_TRUE(matches("10s", duration_up_to(10)));
  EXPECT_TRUE(matches(".1min", duration_up_to(10)));
  EXPECT_FALSE(matches("1min", duration_up_to(10)));
}

TEST(Pattern, Of_durations_knows_the_shortest) {
  for (const char* text :
       {"0s", "0.0ms", "9ms", "9.99ms", "0.009s", ".0099s", "9999us", "9999.9us", "0min", "00s"})
    EXPECT_TRUE(matches(text, duration_below(0.01))) << text;
  for (const char* text :
       {"10ms", "10.0ms", "010ms", "0.01s", ".01s", "0.1s", "1s", "10000us", "1min", "100ms"})
    EXPECT_FALSE(matches(text, duration_below(0.01))) << text;
  EXPECT_TRUE(matches("0.9us", duration_below(1e-6)));
  EXPECT_FALSE(matches("1us", duration_below(1e-6)));
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
  for (const char* good : {"UINT", "uint", "UInt16", "float-32", "Unsigned 16", "uint8_t", "unsigned short",
                           "D-WORD", " INT", "uint 1 6"})
    EXPECT_TRUE(matches(good, pattern)) << good;
  for (const codec::AmbiguousTypeName& each : codec::ambiguous_type_names())
    EXPECT_FALSE(matches(std::string(each.name), pattern)) << each.name;
  for (const char* bad : {"", "int24", "UNIT"}) EXPECT_FALSE(matches(bad, pattern)) << bad;
  EXPECT_FALSE(matches("float32", any_name({"LREAL", "STRING"})));
}

}  // namespace
}  // namespace coupler::schema
