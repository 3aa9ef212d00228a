// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openssl/ssl.h>

#include <string>

#include "coupler/tls/verification.hpp"

namespace coupler::tls {

/// The text of failure_text() for a peer that speaks something else.
constexpr const char* no_tls = "the other side does not speak TLS";
/// The same of one that left, with or without a word: no frame of Modbus can be cut short unnoticed.
constexpr const char* has_left = "the other side has ended the connection";
/// How it begins where the other side has refused this one.
constexpr const char* refuses = "the other side refuses with the TLS alert ";

/// Why a TLS connection has failed, and what to do: this side's own judgement, the alert of the other side by
/// its name in RFC 8446, or what OpenSSL says. `result` is what its last call returned. Forgets OpenSSL's
/// errors.
std::string failure_text(const SSL* ssl, int result, const Verification& verification);

}  // namespace coupler::tls
