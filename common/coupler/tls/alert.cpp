// SPDX-License-Identifier: Apache-2.0
#include "coupler/tls/alert.hpp"

#include <openssl/err.h>

#include <cerrno>
#include <cstring>
#include <string_view>

#include <fmt/format.h>

#include "coupler/tls/openssl.hpp"

namespace coupler::tls {
namespace {

struct Alert {
  int number;
  std::string_view name;
  std::string_view meaning;
};

/// RFC 8446, 6.2.
constexpr Alert alerts[] = {
    {40, "handshake_failure", "no version or cipher in common, or a rule of its own"},
    {42, "bad_certificate",
     "it does not accept this certificate, and its log says why: one that is not valid yet, a malformed "
     "role, another pin"},
    {43, "unsupported_certificate", "this certificate is for another purpose"},
    {44, "certificate_revoked", "this certificate is revoked"},
    {45, "certificate_expired", "this certificate has expired, or its clock is wrong"},
    {46, "certificate_unknown", "it does not accept this certificate"},
    {48, "unknown_ca", "this certificate is from an authority that it does not trust"},
    {49, "access_denied", "this certificate may not connect"},
    {51, "decrypt_error", "a signature is wrong"},
    {70, "protocol_version", "it speaks neither TLS 1.2 nor TLS 1.3"},
    {71, "insufficient_security", "it wants stronger ciphers or keys"},
    {80, "internal_error", "it failed; its log says more"},
    {112, "unrecognized_name", "it is not the server of this name"},
    {116, "certificate_required", "it wants a certificate"},
};

std::string alert_text(int number) {
  for (const Alert& alert : alerts)
    if (alert.number == number)
      return fmt::format("the other side refuses with the TLS alert {}: {}", alert.name, alert.meaning);
  return fmt::format("the other side refuses with the TLS alert {}", number);
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
  if (reason >= SSL_AD_REASON_OFFSET) return alert_text(reason - SSL_AD_REASON_OFFSET);
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
