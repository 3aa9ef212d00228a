// SPDX-License-Identifier: Apache-2.0
// Whether a certificate is believed, and what it says.
#pragma once

#include <openssl/ssl.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace coupler::tls {

using Pin = std::array<std::uint8_t, 32>;  ///< SHA-256 of a certificate's DER

/// Reads what is_pin() allows; nullopt if it is no pin.
std::optional<Pin> parse_pin(std::string_view text);
std::string pin_text(const Pin& pin);
Pin pin_of(const X509* certificate);

struct PinOfKey {
  Pin pin;
  std::string key;  ///< kind: "EC", "RSA" …
};
/// Returns the fingerprints of the first certificate in PEM text and of all others that do not belong to an
/// authority; empty if there is none. It is an error if one is cut or damaged.
tl::expected<std::vector<PinOfKey>, std::string> pins_in(std::string_view pem);

/// Whom the other side of a connection proved to be.
struct Peer {
  std::string name{};                 ///< its subject's common name, for people; "?" if it has none
  std::optional<std::string> role{};  ///< nullopt: its certificate names none
};

/// The requirements for the other side's certificate, and the result of the check. Each connection has one,
/// which outlives its SSL object.
struct Verification {
  bool wants_role = false;   ///< a client's certificate must not have a role that is malformed
  std::optional<Pin> pin{};  ///< in place of authority, name and time
  std::string server{};      ///< DNS name or IP address that the certificate must have; empty: any
  bool only_looks = false;   ///< any is good: only `seen` is wanted

  std::optional<Pin> seen{};  ///< of the other side's certificate, believed or not
  Peer peer{};
  std::string problem{};  ///< why it is not believed, and what to do
};

/// Makes OpenSSL ask `verification` about the other side.
void verify_with(SSL* ssl, Verification& verification);
/// To be called once for a context: connections of it have a verification.
void set_verification(SSL_CTX* context);

/// Checks whether a certificate that was believed once still is, by the authorities and lists of this
/// context, whatever the time is. Returns why not.
std::optional<std::string> why_refused_now(SSL_CTX* context, X509* certificate, STACK_OF(X509) * chain);

/// The role that a certificate names, as Peer. Error: it is malformed.
std::optional<std::string> read_role(const X509* certificate, std::optional<std::string>& role);

/// Returns what is wrong, and what to do, for an error of X509_verify_cert(3). `now` is compared with `own`,
/// this side's certificate, which may be null: a clock before its beginning is not set.
std::string problem_text(int error, const X509* certificate, const X509* own);

}  // namespace coupler::tls
