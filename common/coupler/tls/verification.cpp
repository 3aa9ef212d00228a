// SPDX-License-Identifier: Apache-2.0
#include "coupler/tls/verification.hpp"

#include <openssl/asn1.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/objects.h>
#include <openssl/pem.h>
#include <openssl/x509_vfy.h>
#include <openssl/x509v3.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>
#include <string_view>

#include <fmt/format.h>

#include "coupler/credentials/role_extension.hpp"
#include "coupler/map/security.hpp"
#include "coupler/tls/certificate_names.hpp"
#include "coupler/tls/openssl.hpp"
#include "coupler/tls/pem.hpp"

namespace coupler::tls {
namespace {

using ObjectPtr = std::unique_ptr<ASN1_OBJECT, FreedBy<ASN1_OBJECT_free>>;

const ASN1_OBJECT* role_object() {
  static const ObjectPtr object(OBJ_txt2obj(role_extension_id, 1));
  return object.get();
}

bool is_role(const X509_EXTENSION* extension) {
  return OBJ_cmp(X509_EXTENSION_get_object(const_cast<X509_EXTENSION*>(extension)), role_object()) == 0;
}

/// OpenSSL does not know the role's extension, which may be critical all the same.
bool only_role_is_unknown(const X509* certificate) {
  for (int i = 0; i < X509_get_ext_count(certificate); ++i) {
    X509_EXTENSION* extension = X509_get_ext(certificate, i);
    if (X509_EXTENSION_get_critical(extension) != 0 && X509_supported_extension(extension) == 0 &&
        !is_role(extension))
      return false;
  }
  return true;
}

const char* whose(const X509* certificate) {
  return X509_check_ca(const_cast<X509*>(certificate)) != 0 ? "its authority's" : "its";
}

std::string key_kind(const X509* certificate) {
  const EVP_PKEY* const key = X509_get0_pubkey(certificate);
  const char* const name = key == nullptr ? nullptr : EVP_PKEY_get0_type_name(key);
  return name == nullptr ? "a key of an unknown kind" : name;
}

/// Called by OpenSSL for each error, and for each certificate of the chain that has none. True: it has none
/// here either.
int judge(int ok, X509_STORE_CTX* store) {
  if (ok == 1) {
    const X509* const certificate = X509_STORE_CTX_get_current_cert(store);
    if (certificate == nullptr || !has_weak_curve(certificate)) return 1;
    X509_STORE_CTX_set_error(store, X509_V_ERR_EE_KEY_TOO_SMALL);
    return 0;
  }
  switch (X509_STORE_CTX_get_error(store)) {
    // A certificate in a list stays revoked, however old the list is.
    case X509_V_ERR_CRL_HAS_EXPIRED:
    case X509_V_ERR_CRL_NOT_YET_VALID: break;
    // Those of authorities between have a list where somebody makes one.
    case X509_V_ERR_UNABLE_TO_GET_CRL:
      if (X509_STORE_CTX_get_error_depth(store) == 0) return 0;
      break;
    case X509_V_ERR_UNHANDLED_CRITICAL_EXTENSION:
      if (!only_role_is_unknown(X509_STORE_CTX_get_current_cert(store))) return 0;
      break;
    default: return 0;
  }
  X509_STORE_CTX_set_error(store, X509_V_OK);
  return 1;
}

bool reject(X509_STORE_CTX* store, Verification& verification, std::string problem) {
  verification.problem = std::move(problem);
  X509_STORE_CTX_set_error(store, X509_V_ERR_CERT_REJECTED);
  return false;
}

bool believes(X509_STORE_CTX* store, const SSL* ssl, Verification& verification) {
  const X509* certificate = X509_STORE_CTX_get0_cert(store);
  verification.peer.name = common_name(certificate);
  verification.seen = pin_of(certificate);
  if (verification.only_looks) {
    X509_STORE_CTX_set_error(store, X509_V_OK);
    return true;
  }
  if (verification.pin) {
    if (const Pin& pin = *verification.seen; pin != *verification.pin)
      return reject(
          store, verification,
          fmt::format(
              "its certificate has the pin {}, which is not the one that is expected; if "
              "it was renewed, take the one that 'coupler pin FILE' shows on the device's own machine",
              pin_text(pin)));
    X509_STORE_CTX_set_error(store, X509_V_OK);
    return true;
  }
  X509_STORE_CTX_set_verify_cb(store, judge);
  if (X509_verify_cert(store) != 1) {
    const X509* current = X509_STORE_CTX_get_current_cert(store);
    verification.problem = problem_text(X509_STORE_CTX_get_error(store),
                                        current == nullptr ? certificate : current, SSL_get_certificate(ssl));
    return false;
  }
  if (verification.wants_role)
    if (auto problem = read_role(certificate, verification.peer.role))
      return reject(store, verification, *std::move(problem));
  return true;
}

/// Called by OpenSSL once the other side has sent its certificate.
int verify(X509_STORE_CTX* store, void*) {
  const auto* ssl =
      static_cast<const SSL*>(X509_STORE_CTX_get_ex_data(store, SSL_get_ex_data_X509_STORE_CTX_idx()));
  auto* verification = static_cast<Verification*>(SSL_get_app_data(ssl));
  return verification != nullptr && believes(store, ssl, *verification) ? 1 : 0;
}

}  // namespace

std::optional<Pin> parse_pin(std::string_view text) {
  if (!is_pin(text)) return std::nullopt;
  std::string digits(text.substr(text.find(':') + 1));
  digits.erase(std::remove(digits.begin(), digits.end(), ':'), digits.end());
  Pin pin{};
  for (std::size_t i = 0; i < pin.size(); ++i)
    pin[i] = static_cast<std::uint8_t>(std::stoi(digits.substr(2 * i, 2), nullptr, 16));
  return pin;
}

std::string pin_text(const Pin& pin) { return fmt::format("sha256:{:02x}", fmt::join(pin, "")); }

Pin pin_of(const X509* certificate) {
  Pin pin{};
  unsigned int size = 0;
  X509_digest(certificate, EVP_sha256(), pin.data(), &size);
  return pin;
}

tl::expected<std::vector<PinOfKey>, std::string> pins_in(std::string_view pem) {
  const auto certificates = read_certificates(pem, "the certificate's file");
  if (!certificates) return tl::unexpected(certificates.error());
  std::vector<PinOfKey> pins;
  for (const CertificatePtr& each : *certificates)
    if (pins.empty() || X509_check_ca(each.get()) == 0)
      pins.push_back({pin_of(each.get()), key_kind(each.get())});
  return pins;
}

void set_verification(SSL_CTX* context) { SSL_CTX_set_cert_verify_callback(context, verify, nullptr); }

void verify_with(SSL* ssl, Verification& verification) {
  SSL_set_app_data(ssl, &verification);
  if (verification.server.empty() || verification.pin) return;
  X509_VERIFY_PARAM* param = SSL_get0_param(ssl);
  X509_VERIFY_PARAM_set_hostflags(param, name_flags);
  if (X509_VERIFY_PARAM_set1_ip_asc(param, verification.server.c_str()) == 1) return;
  X509_VERIFY_PARAM_set1_host(param, verification.server.c_str(), 0);
  SSL_set_tlsext_host_name(ssl, verification.server.c_str());
}

std::optional<std::string> why_refused_now(SSL_CTX* context, X509* certificate, STACK_OF(X509) * chain) {
  const StoreContextPtr store(X509_STORE_CTX_new());
  if (!store || X509_STORE_CTX_init(store.get(), SSL_CTX_get_cert_store(context), certificate, chain) != 1)
    return take_openssl_error();
  X509_STORE_CTX_set_default(store.get(), "ssl_client");
  X509_VERIFY_PARAM_set_flags(X509_STORE_CTX_get0_param(store.get()), X509_V_FLAG_NO_CHECK_TIME);
  X509_STORE_CTX_set_verify_cb(store.get(), judge);
  if (X509_verify_cert(store.get()) == 1) return std::nullopt;
  return problem_text(X509_STORE_CTX_get_error(store.get()), certificate, nullptr);
}

std::optional<std::string> read_role(const X509* certificate, std::optional<std::string>& role) {
  const int at = X509_get_ext_by_OBJ(certificate, role_object(), -1);
  if (at < 0) return std::nullopt;
  constexpr const char* remedy = "have it issued again with one role ('coupler certificates')";
  if (X509_get_ext_by_OBJ(certificate, role_object(), at) >= 0)
    return fmt::format("it has more than one role; {}", remedy);
  const ASN1_OCTET_STRING* value = X509_EXTENSION_get_data(X509_get_ext(certificate, at));
  const auto parsed =
      parse_role({ASN1_STRING_get0_data(value), static_cast<std::size_t>(ASN1_STRING_length(value))});
  if (!parsed) return fmt::format("{}; {}", parsed.error(), remedy);
  role = std::string(*parsed);
  return std::nullopt;
}

std::string problem_text(int error, const X509* certificate, const X509* own) {
  switch (error) {
    case X509_V_ERR_CERT_HAS_EXPIRED:
      return fmt::format("{} certificate has expired on {}; renew it", whose(certificate),
                         minute_text(validity_of(certificate).end));
    case X509_V_ERR_CERT_NOT_YET_VALID: {
      const bool is_clock_unset = own != nullptr && X509_cmp_current_time(X509_get0_notBefore(own)) > 0;
      return is_clock_unset
                 ? fmt::format(
                       "the clock of this machine is not set: it says {}, and its own certificate "
                       "begins on {}; set it, by NTP for instance",
                       minute_text(std::chrono::system_clock::now()), minute_text(validity_of(own).begin))
                 : "its certificate " +
                       time_problem(validity_of(certificate), std::chrono::system_clock::now())
                           .value_or("is not valid yet");
    }
    case X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT:
    case X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT_LOCALLY:
    case X509_V_ERR_UNABLE_TO_VERIFY_LEAF_SIGNATURE:
    case X509_V_ERR_SELF_SIGNED_CERT_IN_CHAIN:
    case X509_V_ERR_DEPTH_ZERO_SELF_SIGNED_CERT:
    case X509_V_ERR_CERT_SIGNATURE_FAILURE:
      return "its certificate is from another authority than those in 'ca'; have it issued by one of them";
    case X509_V_ERR_CERT_REVOKED: return "its certificate is revoked; have another one issued";
    case X509_V_ERR_UNABLE_TO_GET_CRL:
      return "'revoked' has no list of the authority that issued its certificate; add that";
    case X509_V_ERR_HOSTNAME_MISMATCH:
    case X509_V_ERR_IP_ADDRESS_MISMATCH:
      return fmt::format(
          "its certificate is for another name or address{}; connect by one that it has, or give that as "
          "'name' (an option: --tls-name)",
          names_text(certificate));
    case X509_V_ERR_INVALID_PURPOSE:
      return "its certificate is for another purpose (that of a server shown by a client, or the other way "
             "round); have one issued for this side";
    case X509_V_ERR_EE_KEY_TOO_SMALL:
    case X509_V_ERR_CA_KEY_TOO_SMALL:
    case X509_V_ERR_CA_MD_TOO_WEAK:
      return fmt::format(
          "{} certificate has a weak key or signature; P-256, or RSA with 2048 bits and SHA-256, is the "
          "least",
          whose(certificate));
    default: return fmt::format("its certificate is not trusted: {}", X509_verify_cert_error_string(error));
  }
}

}  // namespace coupler::tls
