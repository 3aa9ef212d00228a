// SPDX-License-Identifier: Apache-2.0
// Keys, certificates and requests for them (RFC 5280, RFC 2986), as `coupler certificates` makes them.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "coupler/tls/openssl.hpp"

namespace coupler::tls {

enum class KeyKind {
  p256,
  rsa  ///< 3072 bits
};

/// Whom a certificate is for.
struct Subject {
  std::string name;                  ///< common name
  bool is_node = false;              ///< a server; otherwise a client
  std::vector<std::string> hosts{};  ///< of a node: DNS names and IP addresses
  std::string role{};                ///< of a client, 1 to 64 bytes; empty: none

  friend bool operator==(const Subject& a, const Subject& b) {
    return a.name == b.name && a.is_node == b.is_node && a.hosts == b.hosts && a.role == b.role;
  }
};

struct Pem {
  std::string certificate;  ///< or request
  std::string key;
};

constexpr std::chrono::hours authority_life{24 * 365 * 20};
constexpr std::chrono::hours certificate_life{24 * 365 * 2};

/// Makes a new authority. The name has at most 64 bytes.
tl::expected<Pem, std::string> make_authority(const std::string& name, KeyKind kind = KeyKind::p256);

/// A new key and its certificate, with the authority's behind it.
tl::expected<Pem, std::string> issue(const Subject& subject, KeyKind kind, const Pem& authority);

/// A new key and a request for its certificate, which asks for the subject's names or role.
tl::expected<Pem, std::string> request(const Subject& subject, KeyKind kind);

/// Whom a certificate of this kind is for; nullopt: it is no certificate. Addresses are as inet_ntop(3)
/// writes them.
std::optional<Subject> subject_of(const std::string& certificate);

/// Returns from when to when a certificate is good; nullopt if it is no certificate.
std::optional<Validity> validity_of(const std::string& certificate);

/// Returns whether less than a third of a certificate's life is left; nullopt if it is no certificate.
std::optional<bool> is_to_be_renewed(const std::string& certificate);

}  // namespace coupler::tls
