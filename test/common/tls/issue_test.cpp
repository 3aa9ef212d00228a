// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/common/tls/tls_pair.hpp"

namespace coupler::tls {
namespace {

using testing::StartsWith;

TEST(Issue, A_certificate_comes_with_its_authority_behind_it) {
  const Pem own = issue(test_node(), KeyKind::p256, test_authority()).value();
  EXPECT_THAT(own.certificate, StartsWith("-----BEGIN CERTIFICATE-----"));
  EXPECT_THAT(own.certificate, testing::EndsWith(test_authority().certificate));
  EXPECT_THAT(own.key, StartsWith("-----BEGIN PRIVATE KEY-----"));
}

TEST(Issue, Each_time_with_another_key) {
  EXPECT_NE(issue(test_node(), KeyKind::p256, test_authority())->key,
            issue(test_node(), KeyKind::p256, test_authority())->key);
}

TEST(Issue, Only_by_an_authority_with_its_own_key) {
  const Pem wrong{test_authority().certificate, make_authority("other")->key};
  EXPECT_FALSE(issue(test_node(), KeyKind::p256, wrong));
}

TEST(Issue, A_request_is_one) {
  const auto asked = request(test_client(), KeyKind::p256);
  ASSERT_TRUE(asked) << asked.error();
  EXPECT_THAT(asked->certificate, StartsWith("-----BEGIN CERTIFICATE REQUEST-----"));
}

TEST(Issue, A_certificate_says_until_when_it_is_good) {
  const auto life = validity_of(issue(test_node(), KeyKind::p256, test_authority())->certificate);
  ASSERT_TRUE(life);
  EXPECT_GE(life->end - life->begin, certificate_life);
  EXPECT_LE(life->end - life->begin, certificate_life + std::chrono::hours(2));
  EXPECT_EQ(validity_of("nothing"), std::nullopt);
}

TEST(Issue, A_new_certificate_need_not_be_renewed) {
  EXPECT_EQ(is_to_be_renewed(issue(test_node(), KeyKind::p256, test_authority())->certificate), false);
  EXPECT_EQ(is_to_be_renewed("nothing"), std::nullopt);
}

}  // namespace
}  // namespace coupler::tls
