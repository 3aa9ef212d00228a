// SPDX-License-Identifier: Apache-2.0
// Reading PEM text (RFC 7468): all blocks of a kind, or why not.
#pragma once

#include <openssl/pem.h>

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tl/expected.hpp>

#include "coupler/tls/openssl.hpp"

namespace coupler::tls {

/// The password callback for OpenSSL's readers of PEM text, which would ask for the password of a protected
/// key at the terminal.
int no_password(char* room, int size, int writes, void* data);

/// To be read by OpenSSL; it outlives that.
BioPtr reader_of(std::string_view text);

/// How many blocks with one of these names begin in it; one whose first line is cut counts, too.
std::size_t blocks_in(std::string_view pem, std::initializer_list<std::string_view> names);

/// Returns all blocks with these names that `read`, one of OpenSSL's readers, takes. The error says which of
/// `file` cannot be read: others may be missing behind it.
template <class Pointer, auto read>
tl::expected<std::vector<Pointer>, std::string> read_all(std::string_view pem, std::string_view file,
                                                         std::initializer_list<std::string_view> names) {
  std::vector<Pointer> all;
  const BioPtr reader = reader_of(pem);
  while (Pointer next{read(reader.get(), nullptr, no_password, nullptr)}) all.push_back(std::move(next));
  const std::string why = take_openssl_error();  // the end is one
  if (const std::size_t blocks = blocks_in(pem, names); all.size() < blocks)
    return tl::unexpected(fmt::format(
        "{}: block {} of {}, or what stands before it, is cut, damaged or of a kind that OpenSSL does "
        "not know ({}); copy the file again",
        file, all.size() + 1, blocks, why));
  return all;
}

inline tl::expected<std::vector<CertificatePtr>, std::string> read_certificates(std::string_view pem,
                                                                                std::string_view file) {
  return read_all<CertificatePtr, PEM_read_bio_X509>(pem, file, {PEM_STRING_X509, PEM_STRING_X509_OLD});
}

}  // namespace coupler::tls
