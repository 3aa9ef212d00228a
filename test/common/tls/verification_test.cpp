// SPDX-License-Identifier: Apache-2.0
// Whom each side believes. Certificates that are malformed are in test/peers/tls_test.py, which makes them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "coupler/credentials/role_extension.hpp"
#include "test/common/tls/tls_pair.hpp"

namespace coupler::tls {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// What the server and the client say of it; empty: nothing is wrong.
std::pair<std::string, std::string> problems_of(
    const Credentials& servers, const Credentials& clients,
    const Verification& of_client = TlsPair::for_server("press")) {
  TlsPair pair(servers, clients, TlsPair::for_clients(), of_client);
  pair.shake_hands();
  pair.pump();
  return {pair.server.problem(), pair.client.problem()};
}

TEST(Verification, Both_sides_know_each_other) {
  TlsPair pair(credentials_of(test_node()), credentials_of(test_client("operator")));
  pair.shake_hands();
  ASSERT_TRUE(pair.are_open());
  EXPECT_EQ(pair.server.verification().peer.name, "cell1");
  EXPECT_EQ(pair.server.verification().peer.role, "operator");
  EXPECT_EQ(pair.client.verification().peer.name, "press");
}

TEST(Verification, A_client_without_a_role_is_let_in) {
  TlsPair pair(credentials_of(test_node()), credentials_of(test_client("")));
  pair.shake_hands();
  ASSERT_TRUE(pair.are_open());
  EXPECT_EQ(pair.server.verification().peer.role, std::nullopt);
}

TEST(Verification, A_certificate_with_two_roles_has_none_that_counts) {
  const CertificatePtr certificate(X509_new());
  const std::unique_ptr<ASN1_OBJECT, FreedBy<ASN1_OBJECT_free>> id(OBJ_txt2obj(role_extension_id, 1));
  const std::unique_ptr<ASN1_OCTET_STRING, FreedBy<ASN1_OCTET_STRING_free>> value(ASN1_OCTET_STRING_new());
  const std::array<std::uint8_t, 8> viewer{0x0C, 6, 'v', 'i', 'e', 'w', 'e', 'r'};
  ASN1_OCTET_STRING_set(value.get(), viewer.data(), static_cast<int>(viewer.size()));
  const std::unique_ptr<X509_EXTENSION, FreedBy<X509_EXTENSION_free>> extension(
      X509_EXTENSION_create_by_OBJ(nullptr, id.get(), 0, value.get()));
  ASSERT_EQ(X509_add_ext(certificate.get(), extension.get(), -1), 1);
  std::optional<std::string> role;
  EXPECT_EQ(read_role(certificate.get(), role), std::nullopt);
  EXPECT_EQ(role, "viewer");
  ASSERT_EQ(X509_add_ext(certificate.get(), extension.get(), -1), 1);
  role.reset();
  EXPECT_THAT(read_role(certificate.get(), role), testing::Optional(HasSubstr("more than one role")));
  EXPECT_EQ(role, std::nullopt);
}

TEST(Verification, Knows_RSA) {
  const auto [server, client] = problems_of(credentials_of(test_node(), test_authority(), KeyKind::rsa),
                                            credentials_of(test_client(), test_authority(), KeyKind::rsa));
  EXPECT_EQ(server + client, "");
}

TEST(Verification, Another_authority_is_refused_and_each_side_says_why) {
  const Pem other = make_authority("other").value();
  const auto [server, client] =
      problems_of(credentials_of(test_node()), credentials_of(test_client(), other));
  EXPECT_THAT(server, HasSubstr("another authority"));
  EXPECT_THAT(client, AllOf(HasSubstr("unknown_ca"), HasSubstr("authority that it does not trust")));
  const auto [of_server, of_client] =
      problems_of(credentials_of(test_node(), other), credentials_of(test_client()));
  EXPECT_THAT(of_client, HasSubstr("another authority"));
  EXPECT_THAT(of_server, HasSubstr("unknown_ca"));
}

TEST(Verification, A_server_has_the_name_or_address_by_which_it_was_reached) {
  const Credentials node = credentials_of(test_node());
  const Credentials client = credentials_of(test_client());
  for (const char* good : {"press", "10.0.0.7"})
    EXPECT_EQ(problems_of(node, client, TlsPair::for_server(good)).second, "") << good;
  for (const char* bad : {"pres", "press.plant", "10.0.0.8"})
    EXPECT_THAT(problems_of(node, client, TlsPair::for_server(bad)).second,
                HasSubstr("another name or address (it has press, 10.0.0.7)"))
        << bad;
}

TEST(Verification, A_server_is_told_that_it_has_another_name) {
  const Credentials node = credentials_of(test_node());
  const Credentials client = credentials_of(test_client());
  const auto of_server = [&](const char* name) {
    return problems_of(node, client, TlsPair::for_server(name)).first;
  };
  EXPECT_THAT(
      of_server("press.plant"),
      AllOf(HasSubstr("bad_certificate: it connects as 'press.plant', and this certificate is for another "
                      "name or address (it has press, 10.0.0.7)"),
            HasSubstr("--tls-name")));
  const auto names_are_one_reason =
      AllOf(HasSubstr("perhaps it connects by a name or address that the certificate does not have (it has "
                      "press, 10.0.0.7)"),
            HasSubstr("--tls-name"));
  EXPECT_THAT(of_server("10.0.0.8"), names_are_one_reason) << "an address is not told";
  EXPECT_THAT(of_server("press\nplant"), names_are_one_reason) << "that cannot be shown";
}

TEST(Verification, A_server_whose_name_is_right_is_not_told_of_names) {
  // A client that cannot find the name wrong, as one that believes another certificate.
  Verification hard_to_please;
  hard_to_please.pin = Pin{};
  TlsPair pair(credentials_of(test_node()), credentials_of(test_client()), TlsPair::for_clients(),
               hard_to_please);
  SSL_set_tlsext_host_name(pair.client.ssl(), "press");
  pair.shake_hands();
  EXPECT_THAT(pair.server.problem(), AllOf(HasSubstr("bad_certificate"), HasSubstr("another pin"),
                                           testing::Not(HasSubstr("name or address"))));
}

TEST(Verification, One_side_does_not_pass_for_the_other) {
  EXPECT_THAT(problems_of(credentials_of(test_node()), credentials_of(test_node())).first,
              HasSubstr("another purpose"));
  const Subject client_as_server{"press", false, {}, "operator"};
  EXPECT_THAT(problems_of(credentials_of(client_as_server), credentials_of(test_client())).second,
              HasSubstr("another purpose"));
}

TEST(Verification, A_pin_stands_for_authority_and_name) {
  const Pem other = make_authority("other").value();
  const Credentials node = credentials_of(test_node(), other);
  Verification pinned;
  pinned.server = "elsewhere";
  pinned.pin = pins_in(node.certificate)->at(0).pin;
  ASSERT_TRUE(pinned.pin);
  // The client knows nothing of the node's authority, and the node believes the client's.
  EXPECT_EQ(problems_of(node, credentials_of(test_client()), pinned).second, "");
  pinned.pin = pins_in(credentials_of(test_node()).certificate)->at(0).pin;
  EXPECT_THAT(problems_of(node, credentials_of(test_client()), pinned).second, HasSubstr("pin sha256:"));
}

TEST(Verification, Every_certificate_of_a_file_that_is_no_authority_has_a_pin) {
  const std::string both = credentials_of(test_node()).certificate +
                           credentials_of(test_node(), test_authority(), KeyKind::rsa).certificate;
  const auto pins = pins_in(both).value();
  ASSERT_EQ(pins.size(), 2U);
  EXPECT_EQ(pins[0].key, "EC");
  EXPECT_EQ(pins[1].key, "RSA");
  EXPECT_NE(pins[0].pin, pins[1].pin);
  EXPECT_EQ(pins_in(test_authority().certificate)->size(), 1U);
  EXPECT_TRUE(pins_in("no certificate")->empty());
  EXPECT_FALSE(pins_in(both.substr(0, both.size() - 40))) << "one that is cut";
}

TEST(Verification, Pins_have_one_form) {
  const std::string text = "sha256:00112233445566778899aabbccddeeff00112233445566778899AABBCCDDEEFF";
  const auto pin = parse_pin(text);
  ASSERT_TRUE(pin);
  EXPECT_EQ((*pin)[1], 0x11);
  EXPECT_EQ((*pin)[31], 0xFF);
  EXPECT_EQ(
      parse_pin(
          "sha256:00:11:22:33:44:55:66:77:88:99:aa:bb:cc:dd:ee:ff:00:11:22:33:44:55:66:77:88:99:aa:bb:cc:dd:"
          "ee:ff"),
      pin);
  for (const char* bad :
       {"", "sha256:", "sha1:00", "sha256:0011", "00112233445566778899aabbccddeeff00112233445566778899"})
    EXPECT_FALSE(parse_pin(bad)) << bad;
}

TEST(Verification, Who_only_looks_sees_any_certificate) {
  SocketPair wire;
  Verification looks;
  looks.only_looks = true;
  const Credentials node = credentials_of(test_node());
  Session server(Context::make(Side::server, node).value(), wire[0], TlsPair::for_clients());
  Session client(Context::of_stranger(), wire[1], looks);
  for (int i = 0; i < 10; ++i) {
    if (client.state() == Session::State::handshake) client.shake_hands();
    if (server.state() == Session::State::handshake) server.shake_hands();
  }
  EXPECT_EQ(client.verification().seen, pins_in(node.certificate)->at(0).pin);
  EXPECT_THAT(server.problem(), HasSubstr("shows no certificate"));
}

}  // namespace
}  // namespace coupler::tls
