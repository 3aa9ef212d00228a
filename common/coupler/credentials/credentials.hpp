// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "coupler/map/security.hpp"

namespace coupler {

/// The certificate that one side of a TLS connection shows, and those that it believes. Each is PEM text (RFC
/// 7468).
struct Credentials {
  std::string certificate;  ///< its own, with those that lead from it to an authority; of several keys, too
  std::string key;          ///< of the certificate
  std::string ca;           ///< the authorities whose certificates are believed
  std::string revoked;      ///< their lists of what they have revoked; may be empty
};

/// Reads the files. It waits for nothing but the disk: only regular files of
/// at most 1 MiB are read. The error is one line: which file, what is wrong, and what to do. A key that
/// others may read, or that others than its owner may write, is one. Its group may read it if that is the
/// group of this process, or if it is in the folder that systemd made for credentials
/// ($CREDENTIALS_DIRECTORY).
tl::expected<Credentials, std::string> read_credentials(const CredentialFiles& files);

/// One file of that kind: `what` names it in the error.
tl::expected<std::string, std::string> read_pem_file(std::string_view what, std::string_view path,
                                                     std::string_view folder, bool is_secret = false);

}  // namespace coupler
