// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/common/tls/tls_pair.hpp"

namespace coupler::tls {
namespace {

using testing::HasSubstr;

std::string problem_of(const Credentials& credentials, Side side = Side::server) {
  const auto context = Context::make(side, credentials);
  return context ? "" : context.error();
}

TEST(Context, Takes_a_key_with_its_certificate) {
  EXPECT_EQ(problem_of(credentials_of(test_node())), "");
  Credentials half = credentials_of(test_node());
  half.key = credentials_of(test_node()).key;
  EXPECT_THAT(problem_of(half), HasSubstr("does not belong to the certificate"));
}

TEST(Context, Takes_two_keys_of_different_kinds) {
  const Credentials ec = credentials_of(test_node());
  const Credentials rsa = credentials_of(test_node(), test_authority(), KeyKind::rsa);
  Credentials both = ec;
  both.certificate = ec.certificate + rsa.certificate;
  both.key = rsa.key + ec.key;
  EXPECT_EQ(problem_of(both), "");
  TlsPair pair(both, credentials_of(test_client()));
  pair.shake_hands();
  EXPECT_TRUE(pair.are_open()) << pair.client.problem();
}

TEST(Context, Says_which_file_has_what_it_must_not_have) {
  Credentials wrong = credentials_of(test_node());
  wrong.certificate = "nothing";
  EXPECT_THAT(problem_of(wrong), HasSubstr("certificate's file has no PEM certificate"));
  wrong = credentials_of(test_node());
  wrong.key = "nothing";
  EXPECT_THAT(problem_of(wrong), HasSubstr("no PEM key"));
  wrong = credentials_of(test_node());
  wrong.ca = "";
  EXPECT_THAT(problem_of(wrong), HasSubstr("authority's file has no PEM certificate"));
  EXPECT_EQ(problem_of(wrong, Side::client), "") << "it may know the server's pin";
  wrong.ca = "nothing";
  EXPECT_THAT(problem_of(wrong, Side::client), HasSubstr("authority's file has no PEM certificate"));
  wrong = credentials_of(test_node());
  wrong.revoked = "nothing";
  EXPECT_THAT(problem_of(wrong), HasSubstr("no PEM list"));
}

TEST(Context, A_file_that_is_cut_is_refused_though_its_beginning_is_good) {
  Credentials cut = credentials_of(test_node());
  cut.certificate.resize(cut.certificate.size() - 40);  // of the authority's, behind the node's own
  EXPECT_THAT(problem_of(cut), HasSubstr("the certificate's file: block 2 of 2, or"));
  cut = credentials_of(test_node());
  cut.ca += cut.ca.substr(0, cut.ca.size() / 2);
  EXPECT_THAT(problem_of(cut), HasSubstr("the authority's file: block 2 of 2, or"));
  cut = credentials_of(test_node());
  cut.key += cut.key.substr(0, cut.key.size() / 2);
  EXPECT_THAT(problem_of(cut), HasSubstr("the key's file: block 2 of 2, or"));
  cut = credentials_of(test_node());
  cut.revoked = "-----BEGIN X509 CRL-----\r\nMIIB";
  EXPECT_THAT(problem_of(cut), HasSubstr("the list of revoked certificates: block 1 of 1, or"));
}

TEST(Context, A_protected_key_is_refused_and_nobody_is_asked_for_a_password) {
  Credentials wrong = credentials_of(test_node());
  wrong.key = "-----BEGIN ENCRYPTED PRIVATE KEY-----\nMIG=\n-----END ENCRYPTED PRIVATE KEY-----\n";
  EXPECT_THAT(problem_of(wrong), HasSubstr("protected by a password"));
}

TEST(Context, Knows_how_long_its_own_certificate_is_good) {
  const Validity validity = Context::make(Side::server, credentials_of(test_node()))->validity();
  EXPECT_GE(validity.end - validity.begin, certificate_life);
  EXPECT_LT(validity.end - validity.begin, certificate_life + std::chrono::hours(48));
  EXPECT_EQ(expiry_text(validity, std::chrono::system_clock::now()), std::nullopt);
}

std::string objection(const Subject& subject, const std::string& host) {
  return Context::for_strangers(credentials_of(subject))->objection(host).value_or("");
}

TEST(Context, Tells_what_a_browser_would_object_to) {
  for (const char* const host : {"press", "10.0.0.7"}) EXPECT_EQ(objection(test_node(), host), "");
  for (const char* const host : {"10.0.0.8", "pres", "press.local", "::1"})
    EXPECT_THAT(objection(test_node(), host),
                HasSubstr(std::string("not for ") + host + " (it has press, 10.0.0.7)"));
  EXPECT_THAT(objection(test_client(), "cell1"), HasSubstr("not for a server"));
}

}  // namespace
}  // namespace coupler::tls
