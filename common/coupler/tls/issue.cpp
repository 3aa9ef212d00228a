// SPDX-License-Identifier: Apache-2.0
#include "coupler/tls/issue.hpp"

#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/rsa.h>
#include <openssl/x509v3.h>

#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "coupler/credentials/role_extension.hpp"
#include "coupler/map/network.hpp"
#include "coupler/tls/certificate_names.hpp"
#include "coupler/tls/pem.hpp"
#include "coupler/tls/verification.hpp"

namespace coupler::tls {
namespace {

using RequestPtr = std::unique_ptr<X509_REQ, FreedBy<X509_REQ_free>>;
using ExtensionPtr = std::unique_ptr<X509_EXTENSION, FreedBy<X509_EXTENSION_free>>;
using ObjectPtr = std::unique_ptr<ASN1_OBJECT, FreedBy<ASN1_OBJECT_free>>;
using OctetsPtr = std::unique_ptr<ASN1_OCTET_STRING, FreedBy<ASN1_OCTET_STRING_free>>;

tl::unexpected<std::string> failed() { return tl::unexpected("OpenSSL: " + take_openssl_error()); }

KeyPtr make_key(KeyKind kind) {
  constexpr std::size_t rsa_bits = 3072;
  return KeyPtr(kind == KeyKind::rsa ? EVP_RSA_gen(rsa_bits) : EVP_EC_gen("P-256"));
}

std::string text_of(const BioPtr& memory) {
  char* text = nullptr;
  const long size = BIO_get_mem_data(memory.get(), &text);
  return {text, static_cast<std::size_t>(size)};
}

BioPtr memory() { return BioPtr(BIO_new(BIO_s_mem())); }

std::string pem_of(const X509* certificate) {
  const BioPtr out = memory();
  PEM_write_bio_X509(out.get(), certificate);
  return text_of(out);
}

std::string pem_of(const EVP_PKEY* key) {
  const BioPtr out = memory();
  PEM_write_bio_PKCS8PrivateKey(out.get(), key, nullptr, nullptr, 0, nullptr, nullptr);
  return text_of(out);
}

CertificatePtr certificate_of(const std::string& pem) {
  return CertificatePtr(PEM_read_bio_X509(reader_of(pem).get(), nullptr, no_password, nullptr));
}

bool set_name(X509_NAME* name, const std::string& common_name) {
  return 1 == X509_NAME_add_entry_by_NID(name, NID_commonName, MBSTRING_UTF8,
                                         reinterpret_cast<const unsigned char*>(common_name.data()),
                                         static_cast<int>(common_name.size()), -1, 0);
}

std::string alternative_names(const Subject& subject) {
  std::string names;
  for (const std::string& host : subject.hosts)
    names += fmt::format("{}{}:{}", names.empty() ? "" : ",", is_ip_address(host) ? "IP" : "DNS", host);
  return names;
}

/// One DER UTF8String.
ExtensionPtr role_extension(const std::string& role) {
  std::string der{'\x0C', static_cast<char>(role.size())};
  der += role;
  const OctetsPtr octets(ASN1_OCTET_STRING_new());
  ASN1_OCTET_STRING_set(octets.get(), reinterpret_cast<const unsigned char*>(der.data()),
                        static_cast<int>(der.size()));
  const ObjectPtr object(OBJ_txt2obj(role_extension_id, 1));
  return ExtensionPtr(X509_EXTENSION_create_by_OBJ(nullptr, object.get(), 0, octets.get()));
}

using Extensions = std::vector<ExtensionPtr>;

void add(Extensions& all, int which, const std::string& value, X509V3_CTX* context) {
  all.emplace_back(X509V3_EXT_conf_nid(nullptr, context, which, value.c_str()));
}

Extensions extensions_of(const Subject& subject, KeyKind kind) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, nullptr, nullptr, nullptr, nullptr, 0);
  Extensions all;
  add(all, NID_basic_constraints, "critical,CA:FALSE", &context);
  add(all, NID_key_usage,
      kind == KeyKind::rsa ? "critical,digitalSignature,keyEncipherment" : "critical,digitalSignature",
      &context);
  add(all, NID_ext_key_usage, subject.is_node ? "serverAuth" : "clientAuth", &context);
  if (subject.is_node) add(all, NID_subject_alt_name, alternative_names(subject), &context);
  if (!subject.role.empty()) all.push_back(role_extension(subject.role));
  return all;
}

/// A certificate without extensions, which is not signed. Null: OpenSSL says why.
CertificatePtr begin_certificate(const std::string& name, const EVP_PKEY* key, std::chrono::hours life) {
  CertificatePtr certificate(X509_new());
  X509_set_version(certificate.get(), X509_VERSION_3);
  std::array<unsigned char, 16> serial{};
  if (RAND_bytes(serial.data(), serial.size()) != 1) return nullptr;
  serial[0] &= 0x7F;  // a positive number (RFC 5280, 4.1.2.2)
  const std::unique_ptr<BIGNUM, FreedBy<BN_free>> number(BN_bin2bn(serial.data(), serial.size(), nullptr));
  BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(certificate.get()));
  constexpr long clocks_differ = 3600;  // s: a node whose clock is a little behind believes it at once
  X509_gmtime_adj(X509_getm_notBefore(certificate.get()), -clocks_differ);
  X509_time_adj_ex(X509_getm_notAfter(certificate.get()), static_cast<int>(life.count() / 24), 0, nullptr);
  X509_set_pubkey(certificate.get(), const_cast<EVP_PKEY*>(key));
  if (!set_name(X509_get_subject_name(certificate.get()), name)) return nullptr;
  return certificate;
}

bool sign(X509* certificate, const Extensions& extensions, X509* authority, EVP_PKEY* key) {
  X509_set_issuer_name(certificate, X509_get_subject_name(authority));
  for (const ExtensionPtr& extension : extensions)
    if (!extension || X509_add_ext(certificate, extension.get(), -1) != 1) return false;
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, authority, certificate, nullptr, nullptr, 0);
  for (const auto& [which, value] :
       {std::pair(NID_subject_key_identifier, "hash"), std::pair(NID_authority_key_identifier, "keyid")}) {
    const ExtensionPtr extension(X509V3_EXT_conf_nid(nullptr, &context, which, value));
    if (!extension || X509_add_ext(certificate, extension.get(), -1) != 1) return false;
  }
  return X509_sign(certificate, key, EVP_sha256()) > 0;
}

}  // namespace

tl::expected<Pem, std::string> make_authority(const std::string& name, KeyKind kind) {
  const KeyPtr key = make_key(kind);
  if (!key) return failed();
  const CertificatePtr certificate = begin_certificate(name, key.get(), authority_life);
  if (!certificate) return failed();
  Extensions extensions;
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, nullptr, nullptr, nullptr, nullptr, 0);
  add(extensions, NID_basic_constraints, "critical,CA:TRUE,pathlen:0", &context);
  add(extensions, NID_key_usage, "critical,keyCertSign,cRLSign", &context);
  if (!sign(certificate.get(), extensions, certificate.get(), key.get())) return failed();
  return Pem{pem_of(certificate.get()), pem_of(key.get())};
}

tl::expected<Pem, std::string> issue(const Subject& subject, KeyKind kind, const Pem& authority) {
  const CertificatePtr issuer = certificate_of(authority.certificate);
  const KeyPtr issuer_key(
      PEM_read_bio_PrivateKey(reader_of(authority.key).get(), nullptr, no_password, nullptr));
  if (!issuer || !issuer_key || X509_check_private_key(issuer.get(), issuer_key.get()) != 1)
    return tl::unexpected(std::string("the authority's certificate and key do not belong together"));
  const KeyPtr key = make_key(kind);
  if (!key) return failed();
  const CertificatePtr certificate = begin_certificate(subject.name, key.get(), certificate_life);
  if (!certificate || !sign(certificate.get(), extensions_of(subject, kind), issuer.get(), issuer_key.get()))
    return failed();
  return Pem{pem_of(certificate.get()) + authority.certificate, pem_of(key.get())};
}

tl::expected<Pem, std::string> request(const Subject& subject, KeyKind kind) {
  const KeyPtr key = make_key(kind);
  if (!key) return failed();
  const RequestPtr request(X509_REQ_new());
  X509_REQ_set_version(request.get(), X509_REQ_VERSION_1);
  X509_REQ_set_pubkey(request.get(), key.get());
  if (!set_name(X509_REQ_get_subject_name(request.get()), subject.name)) return failed();
  const Extensions extensions = extensions_of(subject, kind);
  const std::unique_ptr<STACK_OF(X509_EXTENSION), void (*)(STACK_OF(X509_EXTENSION)*)> list(
      sk_X509_EXTENSION_new_null(), [](STACK_OF(X509_EXTENSION) * all) { sk_X509_EXTENSION_free(all); });
  for (const ExtensionPtr& extension : extensions) sk_X509_EXTENSION_push(list.get(), extension.get());
  X509_REQ_add_extensions(request.get(), list.get());
  if (X509_REQ_sign(request.get(), key.get(), EVP_sha256()) <= 0) return failed();
  const BioPtr out = memory();
  PEM_write_bio_X509_REQ(out.get(), request.get());
  return Pem{text_of(out), pem_of(key.get())};
}

std::optional<Subject> subject_of(const std::string& certificate) {
  const CertificatePtr parsed = certificate_of(certificate);
  ERR_clear_error();
  if (!parsed) return std::nullopt;
  auto hosts = hosts_of(parsed.get());
  Subject subject{common_name(parsed.get()), hosts.has_value(), {}, {}};
  if (hosts) subject.hosts = *std::move(hosts);
  std::optional<std::string> role;
  if (!read_role(parsed.get(), role) && role) subject.role = *role;
  return subject;
}

std::optional<Validity> validity_of(const std::string& certificate) {
  const CertificatePtr parsed = certificate_of(certificate);
  ERR_clear_error();
  if (!parsed) return std::nullopt;
  return validity_of(parsed.get());
}

std::optional<bool> is_to_be_renewed(const std::string& certificate) {
  const auto validity = validity_of(certificate);
  if (!validity) return std::nullopt;
  return validity->end - std::chrono::system_clock::now() < (validity->end - validity->begin) / 3;
}

}  // namespace coupler::tls
