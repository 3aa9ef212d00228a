// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/tls/openssl.hpp"

namespace coupler::tls {

/// A non-blocking socket for OpenSSL, which does not own it. Its own kind (BIO_s_socket(3)) would end the
/// process by SIGPIPE when the other side has left, unless every program that has TLS ignores that.
/// Throws std::bad_alloc like any container.
BioPtr socket_bio(int socket);

}  // namespace coupler::tls
