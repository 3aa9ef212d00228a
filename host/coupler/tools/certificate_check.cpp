// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/certificate_check.hpp"

#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "coupler/credentials/credentials.hpp"
#include "coupler/map/printable.hpp"
#include "coupler/tls/context.hpp"

namespace coupler::tools {
namespace {

/// Returns why this user cannot read the first of the files that cannot be read.
std::optional<std::string> why_not_here(const CredentialFiles& files) {
  for (const std::string_view path : {files.certificate, files.key, files.ca, files.revoked}) {
    if (path.empty()) continue;
    const std::string full = (std::filesystem::path(files.folder) / path).string();
    if (::access(full.c_str(), R_OK) != 0)
      return fmt::format("{}: {}", printable(full), std::strerror(errno));
  }
  return std::nullopt;
}

std::string life_text(const Validity& validity) {
  return time_problem(validity, std::chrono::system_clock::now())
      .value_or("good until " + minute_text(validity.end));
}

void check(std::string_view key, tls::Side side, const CredentialFiles& files,
           CertificateFindings& findings) {
  if (!files.present()) return;
  if (const auto why = why_not_here(files)) {
    findings.lines.push_back(fmt::format("  files of '{}' are not checked here: {}", key, *why));
    return;
  }
  const auto credentials = read_credentials(files);
  if (!credentials) return findings.problems.push_back(fmt::format("'{}': {}", key, credentials.error()));
  const auto context = tls::Context::make(side, *credentials);
  if (!context) return findings.problems.push_back(fmt::format("'{}': {}", key, context.error()));
  findings.lines.push_back(
      fmt::format("  certificate of '{}': fits its key; {}", key, life_text(context->validity())));
}

}  // namespace

CertificateFindings check_certificates(const Map& map) {
  CertificateFindings findings;
  const Tls& tls = map.connection.tls;
  check("security", tls::Side::server, map.security.files, findings);
  check("tls", tls::Side::client, {tls.certificate, tls.key, tls.ca, {}, tls.folder}, findings);
  return findings;
}

}  // namespace coupler::tools
