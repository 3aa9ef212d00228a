// SPDX-License-Identifier: Apache-2.0
#include "device/node/stderr_log.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <syslog.h>
#include <unistd.h>

#include <cstdio>
#include <string>

namespace coupler::node {
namespace {

constexpr std::string_view speaker = "coupler-node: ";

/// The variable is inherited by processes whose stderr leads elsewhere.
bool is_stderr(const char* stream) {
  struct stat now {};
  return stream != nullptr && ::fstat(STDERR_FILENO, &now) == 0 &&
         fmt::format("{}:{}", now.st_dev, now.st_ino) == stream;
}

}  // namespace

StderrLog::StderrLog(const char* journal_stream) : to_journal_(is_stderr(journal_stream)) {}

void StderrLog::write(std::string_view line) { put(LOG_INFO, speaker, line); }
void StderrLog::warn(std::string_view line) { put(LOG_WARNING, speaker, line); }
void StderrLog::fail(std::string_view line) { put(LOG_ERR, speaker, line); }

void StderrLog::tell(const Diagnostic& diagnostic) {
  const bool is_error = diagnostic.severity == Diagnostic::Severity::error;
  if (to_journal_)
    put(is_error ? LOG_ERR : LOG_WARNING, "", to_string(diagnostic));
  else
    (void)std::fputs(render(diagnostic, Colour::no).c_str(), stderr);
}

void StderrLog::put(int priority, std::string_view who, std::string_view line) const {
  const std::string text =
      to_journal_ ? fmt::format("<{}>{}\n", priority, line) : fmt::format("{}{}\n", who, line);
  // Whoever read it may be gone: that is no reason to end.
  (void)std::fputs(text.c_str(), stderr);
}

}  // namespace coupler::node
