// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace coupler {

/// From when to when a certificate is good.
struct Validity {
  std::chrono::system_clock::time_point begin{};
  std::chrono::system_clock::time_point end{};
};

/// When its end is worth a warning: in the last third of its life, at most 30 days before it ends.
std::chrono::system_clock::time_point warns_from(const Validity& validity);

/// "expires on …; renew it", or that it has; nullopt: there is more left.
std::optional<std::string> expiry_text(const Validity& validity, std::chrono::system_clock::time_point now);

/// Returns expiry_text(), or that the validity has not begun, and what to do.
std::optional<std::string> time_problem(const Validity& validity, std::chrono::system_clock::time_point now);

/// "2026-11-26 08:30 UTC"
std::string minute_text(std::chrono::system_clock::time_point time);

}  // namespace coupler
