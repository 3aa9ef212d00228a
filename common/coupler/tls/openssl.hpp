// SPDX-License-Identifier: Apache-2.0
// Owners of OpenSSL's objects, and the text of its last error.
#pragma once

#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>

#include <memory>
#include <string>

#include "coupler/credentials/validity.hpp"

namespace coupler::tls {

template <auto free>
struct FreedBy {
  template <class T>
  void operator()(T* object) const {
    free(object);
  }
};

using BioPtr = std::unique_ptr<BIO, FreedBy<BIO_free>>;
using KeyPtr = std::unique_ptr<EVP_PKEY, FreedBy<EVP_PKEY_free>>;
using CertificatePtr = std::unique_ptr<X509, FreedBy<X509_free>>;
using CrlPtr = std::unique_ptr<X509_CRL, FreedBy<X509_CRL_free>>;
using StorePtr = std::unique_ptr<X509_STORE, FreedBy<X509_STORE_free>>;
using StoreContextPtr = std::unique_ptr<X509_STORE_CTX, FreedBy<X509_STORE_CTX_free>>;
using ContextPtr = std::unique_ptr<SSL_CTX, FreedBy<SSL_CTX_free>>;
using SslPtr = std::unique_ptr<SSL, FreedBy<SSL_free>>;

/// The reason of an error that OpenSSL noted; "unknown error" for 0.
std::string openssl_error_text(unsigned long code);

/// The reason of the oldest error that OpenSSL noted in this thread, which then has none; "unknown error".
std::string take_openssl_error();

/// Returns the validity of a certificate. A time beyond those of std::chrono::system_clock (1970 to 2262)
/// becomes the last one there.
Validity validity_of(const X509* certificate);

/// Returns whether its key is weaker than P-256. For other kinds of keys the context's security level is
/// enough.
bool has_weak_curve(const X509* certificate);

}  // namespace coupler::tls
