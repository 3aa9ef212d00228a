// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "coupler/credentials/credentials.hpp"
#include "coupler/tls/openssl.hpp"
#include "coupler/tls/verification.hpp"

namespace coupler::tls {

enum class Side { server, client };

/// The data that all connections of one side share: TLS 1.2 and 1.3 with certificates on both sides (MBTPS),
/// ephemeral keys and authenticated ciphers; no tickets, no resumption, no early data, no compression, no
/// renegotiation.
class Context {
 public:
  /// The error is one line: what is wrong with the credentials, and what to do. A client that knows the
  /// server by its pin needs no authority.
  static tl::expected<Context, std::string> make(Side side, const Credentials& credentials);

  /// Makes the context of a client without a certificate, which looks at the certificate of a server.
  static Context of_stranger();

  /// Makes the context of a server whose clients need no certificate, such as browsers, from the certificate
  /// and key of `own` only.
  static tl::expected<Context, std::string> for_strangers(const Credentials& own);

  /// A connection over a connected, non-blocking socket, before its handshake. Both outlive it. Throws
  /// std::bad_alloc like any container.
  SslPtr connection(int socket, Verification& verification) const;

  /// The validity of its own certificate, or of the one that ends first if there are several.
  Validity validity() const;
  /// Why who asks for `host`, a name or an IP address, does not believe its own certificate, or soon will
  /// not, whoever issued it; and what to do. nullopt: nothing is wrong.
  std::optional<std::string> objection(const std::string& host) const;

  /// Returns why it would not believe a certificate that another context believed, whatever the time is;
  /// nullopt if it would.
  std::optional<std::string> why_refused(X509* certificate, STACK_OF(X509) * chain) const {
    return why_refused_now(context_.get(), certificate, chain);
  }

 private:
  Context(Side side, ContextPtr context) : side_(side), context_(std::move(context)) {}

  Side side_;
  ContextPtr context_;
};

}  // namespace coupler::tls
