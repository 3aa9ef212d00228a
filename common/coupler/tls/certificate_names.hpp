// SPDX-License-Identifier: Apache-2.0
// The names that a certificate has. Those that cannot be shown, as one with a line break, are left out.
#pragma once

#include <openssl/x509v3.h>

#include <optional>
#include <string>
#include <vector>

#include "coupler/tls/openssl.hpp"

namespace coupler::tls {

/// How a name is compared with those of a certificate, for X509_check_host(3).
constexpr unsigned int name_flags =
    X509_CHECK_FLAG_NO_PARTIAL_WILDCARDS | X509_CHECK_FLAG_NEVER_CHECK_SUBJECT;

/// Returns the common name of its subject; "?" if it has none.
std::string common_name(const X509* certificate);

/// DNS names and IP addresses, as inet_ntop(3) writes them, under which it serves (RFC 5280 4.2.1.6).
/// nullopt: it has no such extension.
std::optional<std::vector<std::string>> hosts_of(const X509* certificate);

/// " (it has press, 10.0.0.7)"; empty: it has none.
std::string names_text(const X509* certificate);

}  // namespace coupler::tls
