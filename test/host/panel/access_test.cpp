// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/access.hpp"

#include <gmock/gmock.h>

#include <set>
#include <string>
#include <vector>

namespace coupler::host {
namespace {

using testing::MatchesRegex;

std::string bearer(const std::string& token) { return "Bearer " + token; }

TEST(RandomKey, Has_32_hexadecimal_digits) {
  for (int i = 0; i < 100; ++i) EXPECT_THAT(random_key(), MatchesRegex("[0-9a-f]{32}"));
}

TEST(RandomKey, Is_another_one_each_time) {
  std::set<std::string> keys;
  for (int i = 0; i < 1000; ++i) keys.insert(random_key());
  EXPECT_EQ(keys.size(), 1000U);
}

TEST(EqualInConstantTime, Is_equality) {
  EXPECT_TRUE(equal_in_constant_time("", ""));
  EXPECT_TRUE(equal_in_constant_time("abc", "abc"));
  EXPECT_FALSE(equal_in_constant_time("abc", "abd"));
  EXPECT_FALSE(equal_in_constant_time("xbc", "abc"));
  EXPECT_FALSE(equal_in_constant_time("ab", "abc"));
  EXPECT_FALSE(equal_in_constant_time("abc", ""));
  EXPECT_FALSE(equal_in_constant_time({"a\0b", 3}, {"a\0c", 3})) << "a text does not end at 0";
  EXPECT_FALSE(equal_in_constant_time("\x80", {"\0", 1}));
}

TEST(Access, Only_the_key_is_traded) {
  Access access;
  const std::string key = access.key();
  EXPECT_THAT(access.trade(key), MatchesRegex("[0-9a-f]{32}"));
  std::string wrong = key;
  wrong.back() = wrong.back() == '0' ? '1' : '0';
  for (const std::string& other : {std::string(), wrong, key.substr(1), key + "0", key + "\n", " " + key})
    EXPECT_EQ(access.trade(other), "") << other;
}

TEST(Access, Each_panel_has_its_own_key) { EXPECT_NE(Access().key(), Access().key()); }

TEST(Access, A_token_opens_and_is_of_one_page) {
  Access access;
  const std::string first = access.trade(access.key());
  const std::string second = access.trade(access.key());
  EXPECT_NE(first, second);
  ASSERT_TRUE(access.find(bearer(first)));
  ASSERT_TRUE(access.find(bearer(second)));
  EXPECT_EQ(access.find(bearer(first))->token, first);
  EXPECT_EQ(access.find(bearer(first))->number, 1U);
  EXPECT_EQ(access.find(bearer(second))->number, 2U);
}

TEST(Access, A_token_is_of_one_panel) {
  Access one;
  Access other;
  EXPECT_FALSE(other.find(bearer(one.trade(one.key()))));
}

TEST(Access, Nothing_else_opens) {
  Access access;
  EXPECT_FALSE(access.find("Bearer ")) << "nobody has a token yet";
  const std::string token = access.trade(access.key());
  for (const std::string& shown :
       {std::string(), token, std::string("Bearer"), std::string("Bearer "), bearer(token) + " ",
        "Bearer  " + token, bearer(token.substr(1)), "Basic " + token, bearer(access.key()),
        bearer(std::string(32, '0')), "x" + bearer(token)})
    EXPECT_FALSE(access.find(shown)) << shown;
}

TEST(Access, Of_too_many_tokens_that_is_forgotten_which_was_not_shown_for_longest) {
  Access access;
  const std::string in_use = access.trade(access.key());
  std::vector<std::string> others;
  for (std::size_t i = 1; i < Access::most_tokens; ++i) others.push_back(access.trade(access.key()));
  for (const std::string& other : others) {
    EXPECT_TRUE(access.find(bearer(in_use)));
    const std::string newer = access.trade(access.key());
    EXPECT_FALSE(access.find(bearer(other)));
    EXPECT_TRUE(access.find(bearer(newer)));
  }
  EXPECT_TRUE(access.find(bearer(in_use)));
}

TEST(Access, A_wrong_key_makes_no_token_be_forgotten) {
  Access access;
  const std::string token = access.trade(access.key());
  for (std::size_t i = 0; i < 2 * Access::most_tokens; ++i) access.trade("wrong");
  EXPECT_TRUE(access.find(bearer(token)));
}

bool is_own(const std::string& host, const std::string& origin = "", const std::string& local = "127.0.0.1",
            int port = 8502, const std::string& name = "", bool secure = false) {
  return is_own_page(host, origin, local, port, name, secure);
}

TEST(IsOwnPage, Its_address_and_localhost_are_its_own) {
  EXPECT_TRUE(is_own("127.0.0.1:8502"));
  EXPECT_TRUE(is_own("localhost:8502"));
  EXPECT_TRUE(is_own("192.168.1.20:8502", "", "192.168.1.20"));
}

TEST(IsOwnPage, An_address_of_IPv6_stands_in_brackets) {
  EXPECT_TRUE(is_own("[::1]:8502", "", "::1"));
  EXPECT_TRUE(is_own("[fd00::1:20]:8502", "http://[fd00::1:20]:8502", "fd00::1:20"));
  EXPECT_FALSE(is_own("::1:8502", "", "::1"));
  EXPECT_FALSE(is_own("[::1]", "", "::1"));
  EXPECT_FALSE(is_own("[::2]:8502", "", "::1"));
}

// A socket of IPv6 hears IPv4, too; a browser says the address that it was given.
TEST(IsOwnPage, An_address_of_IPv4_that_came_to_a_socket_of_IPv6_is_written_as_one_of_IPv4) {
  EXPECT_TRUE(is_own("127.0.0.1:8502", "", "::ffff:127.0.0.1"));
  EXPECT_TRUE(is_own("192.168.1.20:8502", "http://192.168.1.20:8502", "::ffff:192.168.1.20"));
  EXPECT_FALSE(is_own("192.168.1.21:8502", "", "::ffff:192.168.1.20"));
}

TEST(IsOwnPage, The_port_belongs_to_it) {
  for (const char* host : {"127.0.0.1", "127.0.0.1:", "127.0.0.1:80", "127.0.0.1:8503", "127.0.0.1:85020",
                           "127.0.0.1:08502", "localhost", "127.0.0.1:8502:8502"})
    EXPECT_FALSE(is_own(host)) << host;
}

TEST(IsOwnPage, Port_80_is_not_written) {
  EXPECT_TRUE(is_own("127.0.0.1", "", "127.0.0.1", 80));
  EXPECT_TRUE(is_own("127.0.0.1:80", "", "127.0.0.1", 80));
  EXPECT_TRUE(is_own("press.local", "http://press.local", "127.0.0.1", 80, "press.local"));
  EXPECT_TRUE(is_own("[::1]", "http://[::1]", "::1", 80));
  EXPECT_FALSE(is_own("evil.example", "", "127.0.0.1", 80));
  EXPECT_FALSE(is_own("127.0.0.1:8502", "", "127.0.0.1", 80));
}

TEST(IsOwnPage, With_HTTPS_its_origins_are_of_HTTPS_and_port_443_is_not_written) {
  const auto is_secure = [](const std::string& host, const std::string& origin, int port) {
    return is_own(host, origin, "127.0.0.1", port, "press.local", true);
  };
  EXPECT_TRUE(is_secure("press.local:8502", "https://press.local:8502", 8502));
  EXPECT_TRUE(is_secure("press.local", "https://press.local", 443));
  EXPECT_FALSE(is_secure("press.local:8502", "http://press.local:8502", 8502));
  EXPECT_FALSE(is_secure("press.local", "", 80));
}

TEST(IsOwnPage, A_name_is_its_own_only_if_it_was_given) {
  EXPECT_FALSE(is_own("press.local:8502"));
  EXPECT_TRUE(is_own("press.local:8502", "", "127.0.0.1", 8502, "press.local"));
  EXPECT_TRUE(is_own("127.0.0.1:8502", "", "127.0.0.1", 8502, "press.local"));
  EXPECT_FALSE(is_own("other.press.local:8502", "", "127.0.0.1", 8502, "press.local"));
  EXPECT_FALSE(is_own(":8502")) << "without a name, no name is no name";
}

// Browsers write names in small letters, however somebody has typed them.
TEST(IsOwnPage, Names_are_the_same_in_capitals) {
  EXPECT_TRUE(is_own("press.local:8502", "http://press.local:8502", "127.0.0.1", 8502, "Press.local"));
}

TEST(IsOwnPage, A_name_that_somebody_elses_DNS_gives_this_machine_is_not_its_own) {
  for (const char* host :
       {"evil.example:8502", "127.0.0.1.evil.example:8502", "localhost.evil.example:8502", "evil.example",
        "0.0.0.0:8502", "127.0.0.2:8502", "127.1:8502", "2130706433:8502", "127.0.0.1:8502.evil.example",
        "user@127.0.0.1:8502", "127.0.0.1:8502,evil.example", " 127.0.0.1:8502", "localhost.:8502", ""})
    EXPECT_FALSE(is_own(host)) << host;
  EXPECT_FALSE(is_own("evil.example:8502", "http://evil.example:8502"))
      << "a page of that name is the origin of what it asks for";
}

TEST(IsOwnPage, An_origin_is_the_host) {
  EXPECT_TRUE(is_own("127.0.0.1:8502", "http://127.0.0.1:8502"));
  EXPECT_TRUE(is_own("localhost:8502", "http://localhost:8502"));
  for (const char* origin :
       {"http://evil.example", "http://evil.example:8502", "null", "https://127.0.0.1:8502",
        "http://127.0.0.1:8503", "http://127.0.0.1", "http://localhost:8502", "http://127.0.0.1:8502/",
        "http://127.0.0.1:8502.evil.example", "127.0.0.1:8502", "file://", " "})
    EXPECT_FALSE(is_own("127.0.0.1:8502", origin)) << origin;
}

}  // namespace
}  // namespace coupler::host
