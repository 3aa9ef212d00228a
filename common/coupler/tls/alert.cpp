// SPDX-License-Identifier: Apache-2.0
#include "coupler/tls/alert.hpp"

#include <openssl/err.h>
#include <openssl/x509v3.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

#include "coupler/codec/text.hpp"
#include "coupler/tls/certificate_names.hpp"
#include "coupler/tls/openssl.hpp"

namespace coupler::tls {
namespace {

struct Alert {
  int number;
  std::string_view name;
  std::string_view meaning;
};

constexpr int bad_certificate = 42;
constexpr int certificate_unknown = 46;

/// RFC 8446, 6.2.
constexpr Alert alerts[] = {
    {40, "handshake_failure", "no version or cipher in common, or a rule of its own"},
    {bad_certificate, "bad_certificate",
     "it does not accept this certificate, and its log says why: one that is not valid yet, a malformed "
     "role, a weak key"},
    {43, "unsupported_certificate", "this certificate is for another purpose"},
    {44, "certificate_revoked", "this certificate is revoked"},
    {45, "certificate_expired", "this certificate has expired, or its clock is wrong"},
    {certificate_unknown, "certificate_unknown", "it does not accept this certificate"},
    {48, "unknown_ca", "this certificate is from an authority that it does not trust"},
    {49, "access_denied", "this certificate may not connect"},
    {51, "decrypt_error", "a signature is wrong"},
    {70, "protocol_version", "it speaks neither TLS 1.2 nor TLS 1.3"},
    {71, "insufficient_security", "it wants stronger ciphers or keys"},
    {80, "internal_error", "it failed; its log says more"},
    {112, "unrecognized_name", "it is not the server of this name"},
    {116, "certificate_required", "it wants a certificate"},
};

/// Returns what a client may have against the certificate of this server where its alert does not say that.
/// One that connects by a name tells it, and one that connects by an address does not.
std::string objection_to_server(const SSL* ssl) {
  X509* const own = SSL_get_certificate(ssl);
  const char* const name = SSL_get_servername(ssl, TLSEXT_NAMETYPE_host_name);
  const bool is_known = name != nullptr && codec::is_plain_text(name);
  if (is_known && X509_check_host(own, name, 0, name_flags, nullptr) == 1)
    return "it does not accept this certificate, and its log says why: one that is not valid yet, another "
           "pin";
  constexpr const char* remedy =
      "let it connect by one that the certificate has, or give it that as 'name' (an option: --tls-name), or "
      "make a certificate that has the other one, too ('coupler certificates --node')";
  if (is_known)
    return fmt::format("it connects as '{}', and this certificate is for another name or address{}; {}", name,
                       names_text(own), remedy);
  return fmt::format(
      "it does not accept this certificate, and its log says why: perhaps it connects by a name or "
      "address that the certificate does not have{}; {}",
      names_text(own), remedy);
}

std::string alert_text(const SSL* ssl, int number) {
  const Alert* const known = std::find_if(std::begin(alerts), std::end(alerts),
                                          [=](const Alert& each) { return each.number == number; });
  if (known == std::end(alerts)) return fmt::format("{}{}", refuses, number);
  const bool may_be_name = number == bad_certificate || number == certificate_unknown;
  return fmt::format(
      "{}{}: {}", refuses, known->name,
      SSL_is_server(ssl) != 0 && may_be_name ? objection_to_server(ssl) : std::string(known->meaning));
}

/// Returns the first error of TLS itself among those that OpenSSL has noted. How many follow it differs
/// between releases.
unsigned long first_of_tls() {
  const unsigned long first = ERR_peek_error();
  for (unsigned long code = ERR_get_error(); code != 0; code = ERR_get_error())
    if (ERR_GET_LIB(code) == ERR_LIB_SSL) return code;
  return first;
}

}  // namespace

std::string failure_text(const SSL* ssl, int result, const Verification& verification) {
  const int system_error = errno;
  const int kind = SSL_get_error(ssl, result);
  const unsigned long code = first_of_tls();
  ERR_clear_error();
  const int reason = ERR_GET_REASON(code);
  std::string text = openssl_error_text(code);
  if (!verification.problem.empty()) return verification.problem;
  if (kind == SSL_ERROR_ZERO_RETURN) return has_left;
  if (kind == SSL_ERROR_SYSCALL)
    return system_error == 0 || system_error == ECONNRESET || system_error == EPIPE
               ? has_left
               : std::strerror(system_error);
  if (ERR_GET_LIB(code) != ERR_LIB_SSL) return text;
  if (reason >= SSL_AD_REASON_OFFSET) return alert_text(ssl, reason - SSL_AD_REASON_OFFSET);
  switch (reason) {
    case SSL_R_UNEXPECTED_EOF_WHILE_READING: return has_left;
    case SSL_R_WRONG_VERSION_NUMBER:
    case SSL_R_HTTP_REQUEST:
    case SSL_R_PACKET_LENGTH_TOO_LONG: return no_tls;
    case SSL_R_UNSUPPORTED_PROTOCOL:
    case SSL_R_VERSION_TOO_LOW: return "the other side speaks neither TLS 1.2 nor TLS 1.3";
    case SSL_R_NO_SHARED_CIPHER: return "the two sides have no cipher in common";
    case SSL_R_PEER_DID_NOT_RETURN_A_CERTIFICATE: return "the other side shows no certificate";
    default: return text;
  }
}

}  // namespace coupler::tls
