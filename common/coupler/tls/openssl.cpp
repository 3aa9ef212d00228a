// SPDX-License-Identifier: Apache-2.0
#include "coupler/tls/openssl.hpp"

#include <openssl/err.h>

#include <ctime>

namespace coupler::tls {

std::string take_openssl_error() {
  const unsigned long code = ERR_get_error();
  ERR_clear_error();
  const char* reason = code == 0 ? nullptr : ERR_reason_error_string(code);
  return reason == nullptr ? "unknown error" : reason;
}

Validity validity_of(const X509* certificate) {
  const auto time = [](const ASN1_TIME* from) {
    std::tm parts{};
    return ASN1_TIME_to_tm(from, &parts) == 1 ? std::chrono::system_clock::from_time_t(::timegm(&parts))
                                              : std::chrono::system_clock::time_point{};
  };
  return {time(X509_get0_notBefore(certificate)), time(X509_get0_notAfter(certificate))};
}

int no_password(char*, int, int, void*) { return -1; }

BioPtr reader_of(std::string_view text) {
  return BioPtr(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
}

}  // namespace coupler::tls
