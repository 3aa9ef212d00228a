// SPDX-License-Identifier: Apache-2.0
#include "coupler/tls/openssl.hpp"

#include <openssl/err.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>

namespace coupler::tls {

std::string openssl_error_text(unsigned long code) {
  const char* reason = code == 0 ? nullptr : ERR_reason_error_string(code);
  return reason == nullptr ? "unknown error" : reason;
}

std::string take_openssl_error() {
  const unsigned long code = ERR_get_error();
  ERR_clear_error();
  return openssl_error_text(code);
}

Validity validity_of(const X509* certificate) {
  using Clock = std::chrono::system_clock;
  const auto time = [](const ASN1_TIME* to) -> Clock::time_point {
    // Without std::time_t, which ends in 2038 where it has 32 bits. The year 9999 means that the certificate
    // of a device never ends (IEEE 802.1AR, 8.7).
    const std::unique_ptr<ASN1_TIME, FreedBy<ASN1_TIME_free>> epoch(ASN1_TIME_set(nullptr, 0));
    int days = 0;
    int seconds = 0;
    if (ASN1_TIME_diff(&days, &seconds, epoch.get(), to) != 1) return {};
    const std::chrono::seconds since =
        std::chrono::hours(24 * std::int64_t{days}) + std::chrono::seconds(seconds);
    constexpr auto last = std::chrono::duration_cast<std::chrono::seconds>(Clock::duration::max());
    return Clock::time_point(std::clamp(since, std::chrono::seconds(0), last));
  };
  return {time(X509_get0_notBefore(certificate)), time(X509_get0_notAfter(certificate))};
}

bool has_weak_curve(const X509* certificate) {
  constexpr int bits_of_p256 = 128;
  const EVP_PKEY* const key = X509_get0_pubkey(certificate);
  return key != nullptr && EVP_PKEY_get_base_id(key) == EVP_PKEY_EC &&
         EVP_PKEY_get_security_bits(key) < bits_of_p256;
}

}  // namespace coupler::tls
