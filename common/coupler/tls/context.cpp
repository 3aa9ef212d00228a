// SPDX-License-Identifier: Apache-2.0
#include "coupler/tls/context.hpp"

#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <new>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coupler/tls/certificate_names.hpp"
#include "coupler/tls/pem.hpp"
#include "coupler/tls/socket_bio.hpp"

namespace coupler::tls {
namespace {

using Problem = tl::unexpected<std::string>;

Problem problem(std::string text) { return tl::unexpected(std::move(text)); }

tl::expected<std::vector<KeyPtr>, std::string> read_keys(const std::string& pem) {
  if (pem.find("ENCRYPTED") != std::string::npos)
    return problem("the key is protected by a password; 'openssl pkey -in KEY -out NEW' removes it");
  auto all = read_all<KeyPtr, PEM_read_bio_PrivateKey>(
      pem, "the key's file", {PEM_STRING_PKCS8INF, PEM_STRING_ECPRIVATEKEY, PEM_STRING_RSA});
  if (all && all->empty())
    return problem(
        "the key's file has no PEM key ('-----BEGIN PRIVATE KEY-----'); 'openssl pkey -inform DER' converts "
        "one");
  return all;
}

/// Shows, for each key, the certificate that belongs to it, followed by those of the file that belong to
/// none.
tl::expected<void, std::string> use_own(SSL_CTX* context, const Credentials& credentials) {
  auto certificates = read_certificates(credentials.certificate, "the certificate's file");
  if (!certificates) return problem(std::move(certificates).error());
  if (certificates->empty())
    return problem(
        "the certificate's file has no PEM certificate ('-----BEGIN CERTIFICATE-----'); 'openssl x509 "
        "-inform "
        "DER' converts one");
  auto keys = read_keys(credentials.key);
  if (!keys) return problem(std::move(keys).error());
  std::vector<std::pair<CertificatePtr, KeyPtr>> own;
  for (KeyPtr& key : *keys)
    for (CertificatePtr& certificate : *certificates)
      if (certificate && X509_check_private_key(certificate.get(), key.get()) == 1) {
        own.emplace_back(std::move(certificate), std::move(key));
        break;
      }
  ERR_clear_error();
  if (own.size() != keys->size())
    return problem(
        "the key does not belong to the certificate; a copy of the two may not be complete, or one of them "
        "was renewed");
  const std::unique_ptr<STACK_OF(X509), void (*)(STACK_OF(X509)*)> chain(
      sk_X509_new_null(), [](STACK_OF(X509) * all) { sk_X509_free(all); });
  for (const CertificatePtr& certificate : *certificates)
    if (certificate) sk_X509_push(chain.get(), certificate.get());
  for (const auto& [certificate, key] : own) {
    const bool is_weak = has_weak_curve(certificate.get());
    if (is_weak || SSL_CTX_use_cert_and_key(context, certificate.get(), key.get(), chain.get(), 1) != 1)
      return problem(
          fmt::format("the certificate cannot be used: {}; have it issued again with P-256, or RSA with 2048 "
                      "bits or more, and SHA-256",
                      is_weak ? "its key is too weak" : take_openssl_error()));
  }
  return {};
}

/// Returns the authority that has made a list, by its name and its signature; null if none has.
const X509* maker_of(const X509_CRL* list, const std::vector<CertificatePtr>& authorities) {
  const auto has_made = [list](const CertificatePtr& authority) {
    return X509_NAME_cmp(X509_CRL_get_issuer(list), X509_get_subject_name(authority.get())) == 0 &&
           X509_CRL_verify(const_cast<X509_CRL*>(list), X509_get0_pubkey(authority.get())) == 1;
  };
  const auto found = std::find_if(authorities.begin(), authorities.end(), has_made);
  return found == authorities.end() ? nullptr : found->get();
}

struct RevocationList {
  CrlPtr list;
  const X509* maker;  ///< null: of an authority between, which clients show
};

/// Returns an extension of which a list has only one, a number for instance; null if it has none.
template <class T, auto free>
std::unique_ptr<T, FreedBy<free>> extension_of(const X509_CRL* list, int which) {
  return std::unique_ptr<T, FreedBy<free>>(
      static_cast<T*>(X509_CRL_get_ext_d2i(list, which, nullptr, nullptr)));
}

/// An authority that was made anew has the same name and another key.
bool are_of_one_maker(const RevocationList& a, const RevocationList& b) {
  if (a.maker != nullptr || b.maker != nullptr) return a.maker == b.maker;
  if (X509_NAME_cmp(X509_CRL_get_issuer(a.list.get()), X509_CRL_get_issuer(b.list.get())) != 0) return false;
  const auto key_of = [](const CrlPtr& list) {
    return extension_of<AUTHORITY_KEYID, AUTHORITY_KEYID_free>(list.get(), NID_authority_key_identifier);
  };
  const auto one = key_of(a.list);
  const auto other = key_of(b.list);
  const ASN1_OCTET_STRING* one_id = one ? one->keyid : nullptr;
  const ASN1_OCTET_STRING* other_id = other ? other->keyid : nullptr;
  if (one_id == nullptr || other_id == nullptr) return one_id == other_id;
  return ASN1_OCTET_STRING_cmp(one_id, other_id) == 0;
}

/// By their times; lists of one second by their numbers.
bool is_newer(const X509_CRL* a, const X509_CRL* b) {
  if (const int order = ASN1_TIME_compare(X509_CRL_get0_lastUpdate(a), X509_CRL_get0_lastUpdate(b));
      order != 0)
    return order > 0;
  const auto one = extension_of<ASN1_INTEGER, ASN1_INTEGER_free>(a, NID_crl_number);
  const auto other = extension_of<ASN1_INTEGER, ASN1_INTEGER_free>(b, NID_crl_number);
  return one && other && ASN1_INTEGER_cmp(one.get(), other.get()) > 0;
}

bool has(const CrlPtr& list, int extension) {
  return X509_CRL_get_ext_by_NID(list.get(), extension, -1) >= 0;
}

/// A list of some certificates does not.
bool takes_the_place_of(const RevocationList& newer, const RevocationList& older) {
  const auto is_of_all = [](const CrlPtr& list) { return !has(list, NID_issuing_distribution_point); };
  return are_of_one_maker(newer, older) && is_of_all(newer.list) && is_of_all(older.list) &&
         is_newer(newer.list.get(), older.list.get());
}

/// Only the newest list of each authority counts. OpenSSL would rather take an older one that is in date.
tl::expected<void, std::string> believe_lists(X509_STORE* store, const std::string& pem,
                                              const std::vector<CertificatePtr>& authorities) {
  auto read =
      read_all<CrlPtr, PEM_read_bio_X509_CRL>(pem, "the list of revoked certificates", {PEM_STRING_X509_CRL});
  if (!read) return problem(std::move(read).error());
  if (read->empty())
    return problem(
        "the list of revoked certificates has no PEM list ('-----BEGIN X509 CRL-----'); 'openssl crl -inform "
        "DER' converts one");
  if (std::any_of(read->begin(), read->end(), [](const CrlPtr& list) { return has(list, NID_delta_crl); }))
    return problem(
        "the list of revoked certificates tells only what has changed since another one (a delta CRL); give "
        "whole lists");
  std::vector<RevocationList> lists;
  for (CrlPtr& list : *read) {
    const X509* maker = maker_of(list.get(), authorities);
    lists.push_back({std::move(list), maker});
  }
  if (std::none_of(lists.begin(), lists.end(), [](const auto& each) { return each.maker != nullptr; }))
    return problem(
        "the list of revoked certificates comes from none of the authorities in 'ca', so that all of their "
        "clients would be refused; have it made by each of them");
  for (const RevocationList& each : lists) {
    const auto replaces = [&each](const RevocationList& other) { return takes_the_place_of(other, each); };
    if (std::none_of(lists.begin(), lists.end(), replaces)) X509_STORE_add_crl(store, each.list.get());
  }
  ERR_clear_error();
  X509_STORE_set_flags(store, X509_V_FLAG_CRL_CHECK | X509_V_FLAG_CRL_CHECK_ALL);
  return {};
}

tl::expected<void, std::string> believe(SSL_CTX* context, Side side, const Credentials& credentials) {
  X509_STORE* store = SSL_CTX_get_cert_store(context);
  const auto authorities = read_certificates(credentials.ca, "the authority's file");
  if (!authorities) return problem(authorities.error());
  if (authorities->empty() && (side == Side::server || !credentials.ca.empty()))
    return problem(
        "the authority's file has no PEM certificate ('-----BEGIN CERTIFICATE-----'), so that nobody could "
        "be trusted; 'openssl x509 -inform DER' converts one");
  for (const CertificatePtr& authority : *authorities) {
    X509_STORE_add_cert(store, authority.get());
    SSL_CTX_add_client_CA(context, authority.get());
  }
  // An authority below another one can be believed by itself: the other may have more below it.
  X509_STORE_set_flags(store, X509_V_FLAG_PARTIAL_CHAIN);
  if (credentials.revoked.empty()) return {};
  return believe_lists(store, credentials.revoked, *authorities);
}

void set_rules(SSL_CTX* context) {
  SSL_CTX_set_min_proto_version(context, TLS1_2_VERSION);
  SSL_CTX_set_security_level(context, 2);  // 112 bits: RSA with 2048, no SHA-1
  SSL_CTX_set_cipher_list(context, "ECDHE+AESGCM:ECDHE+CHACHA20:ECDHE+AESCCM");
  SSL_CTX_set_options(context, SSL_OP_NO_TICKET | SSL_OP_NO_COMPRESSION | SSL_OP_NO_RENEGOTIATION);
  SSL_CTX_set_num_tickets(context, 0);
  SSL_CTX_set_session_cache_mode(context, SSL_SESS_CACHE_OFF);
  SSL_CTX_set_mode(context, SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER |
                                SSL_MODE_RELEASE_BUFFERS);
  // One call handles one record, so that a flood of those without data is seen, and others have their turn.
  SSL_CTX_clear_mode(context, SSL_MODE_AUTO_RETRY);
  SSL_CTX_set_verify(context, SSL_VERIFY_PEER | SSL_VERIFY_FAIL_IF_NO_PEER_CERT, nullptr);
  set_verification(context);
}

}  // namespace

tl::expected<Context, std::string> Context::make(Side side, const Credentials& credentials) {
  ERR_clear_error();
  ContextPtr context(SSL_CTX_new(side == Side::server ? TLS_server_method() : TLS_client_method()));
  if (!context) return problem(take_openssl_error());
  set_rules(context.get());
  if (auto used = use_own(context.get(), credentials); !used) return problem(std::move(used).error());
  if (auto believed = believe(context.get(), side, credentials); !believed)
    return problem(std::move(believed).error());
  return Context(side, std::move(context));
}

Context Context::of_stranger() {
  ContextPtr context(SSL_CTX_new(TLS_client_method()));
  if (!context) throw std::bad_alloc();
  set_rules(context.get());
  return Context(Side::client, std::move(context));
}

tl::expected<Context, std::string> Context::for_strangers(const Credentials& own) {
  ERR_clear_error();
  ContextPtr context(SSL_CTX_new(TLS_server_method()));
  if (!context) return problem(take_openssl_error());
  set_rules(context.get());
  SSL_CTX_set_verify(context.get(), SSL_VERIFY_NONE, nullptr);
  if (auto used = use_own(context.get(), own); !used) return problem(std::move(used).error());
  return Context(Side::server, std::move(context));
}

SslPtr Context::connection(int socket, Verification& verification) const {
  SslPtr ssl(SSL_new(context_.get()));
  if (!ssl) throw std::bad_alloc();
  BIO* const bio = socket_bio(socket).release();  // it is the connection's then, for both directions
  SSL_set_bio(ssl.get(), bio, bio);
  verify_with(ssl.get(), verification);
  if (side_ == Side::server)
    SSL_set_accept_state(ssl.get());
  else
    SSL_set_connect_state(ssl.get());
  return ssl;
}

Validity Context::validity() const {
  SSL_CTX* context = context_.get();
  std::optional<Validity> first;
  for (long which = SSL_CERT_SET_FIRST; SSL_CTX_set_current_cert(context, which) == 1;
       which = SSL_CERT_SET_NEXT) {
    const Validity each = validity_of(SSL_CTX_get0_certificate(context));
    if (!first || each.end < first->end) first = each;
  }
  return first.value_or(Validity{});
}

std::optional<std::string> Context::objection(const std::string& host) const {
  X509* const own = SSL_CTX_get0_certificate(context_.get());
  if (auto problem = time_problem(validity(), std::chrono::system_clock::now())) return "it " + *problem;
  if (X509_check_purpose(own, X509_PURPOSE_SSL_SERVER, 0) != 1)
    return "it is not for a server; have one issued that is ('coupler certificates --node')";
  const unsigned flags = X509_CHECK_FLAG_NO_PARTIAL_WILDCARDS | X509_CHECK_FLAG_NEVER_CHECK_SUBJECT;
  if (X509_check_ip_asc(own, host.c_str(), 0) != 1 &&
      X509_check_host(own, host.c_str(), host.size(), flags, nullptr) != 1)
    return fmt::format("it is not for {}{}; have one issued that is, or give a name that it has with --name",
                       host, names_text(own));
  return std::nullopt;
}

}  // namespace coupler::tls
