// SPDX-License-Identifier: Apache-2.0
#include "coupler/tls/openssl.hpp"

#include <openssl/err.h>

namespace coupler::tls {

std::string take_openssl_error() {
  const unsigned long code = ERR_get_error();
  ERR_clear_error();
  const char* reason = code == 0 ? nullptr : ERR_reason_error_string(code);
  return reason == nullptr ? "unknown error" : reason;
}

std::int64_t seconds_between(const ASN1_TIME* from, const ASN1_TIME* to) {
  constexpr std::int64_t day = 24 * 3600;
  int days = 0;
  int rest = 0;
  ASN1_TIME_diff(&days, &rest, from, to);
  return days * day + rest;
}

int no_password(char*, int, int, void*) { return -1; }

BioPtr reader_of(std::string_view text) {
  return BioPtr(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
}

}  // namespace coupler::tls
