// SPDX-License-Identifier: Apache-2.0
#include "coupler/tls/certificate_names.hpp"

#include <arpa/inet.h>
#include <openssl/x509v3.h>

#include <array>
#include <memory>

#include <fmt/format.h>

#include "coupler/codec/text.hpp"

namespace coupler::tls {
namespace {

using Names = std::unique_ptr<GENERAL_NAMES, FreedBy<GENERAL_NAMES_free>>;

/// nullopt: it is of another kind.
std::optional<std::string> host_of(const GENERAL_NAME& name) {
  if (name.type != GEN_DNS && name.type != GEN_IPADD) return std::nullopt;
  const ASN1_STRING* value = name.type == GEN_DNS ? name.d.dNSName : name.d.iPAddress;
  const auto* bytes = reinterpret_cast<const char*>(ASN1_STRING_get0_data(value));
  const auto size = static_cast<std::size_t>(ASN1_STRING_length(value));
  if (name.type == GEN_DNS) return std::string(bytes, size);
  if (size != sizeof(in_addr) && size != sizeof(in6_addr)) return std::nullopt;
  std::array<char, INET6_ADDRSTRLEN> text{};
  ::inet_ntop(size == sizeof(in_addr) ? AF_INET : AF_INET6, bytes, text.data(), text.size());
  return std::string(text.data());
}

}  // namespace

std::string common_name(const X509* certificate) {
  constexpr std::size_t most_bytes = 64;
  const X509_NAME* subject = X509_get_subject_name(certificate);
  const int at = X509_NAME_get_index_by_NID(const_cast<X509_NAME*>(subject), NID_commonName, -1);
  if (at < 0) return "?";
  unsigned char* text = nullptr;
  const int size = ASN1_STRING_to_UTF8(&text, X509_NAME_ENTRY_get_data(X509_NAME_get_entry(subject, at)));
  if (size < 0) return "?";
  const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owner(text,
                                                                       [](auto* p) { OPENSSL_free(p); });
  const std::string name(reinterpret_cast<const char*>(text), static_cast<std::size_t>(size));
  return !name.empty() && name.size() <= most_bytes && codec::is_plain_text(name) ? name : "?";
}

std::optional<std::vector<std::string>> hosts_of(const X509* certificate) {
  const Names names(
      static_cast<GENERAL_NAMES*>(X509_get_ext_d2i(certificate, NID_subject_alt_name, nullptr, nullptr)));
  if (!names) return std::nullopt;
  std::vector<std::string> hosts;
  for (int i = 0; i < sk_GENERAL_NAME_num(names.get()); ++i)
    if (auto host = host_of(*sk_GENERAL_NAME_value(names.get(), i)); host && codec::is_plain_text(*host))
      hosts.push_back(*std::move(host));
  return hosts;
}

std::string names_text(const X509* certificate) {
  constexpr std::size_t most = 8;
  std::vector<std::string> names = hosts_of(certificate).value_or(std::vector<std::string>{});
  if (names.empty()) return {};
  if (names.size() > most) {
    names.resize(most);
    names.emplace_back("more");
  }
  return fmt::format(" (it has {})", fmt::join(names, ", "));
}

}  // namespace coupler::tls
