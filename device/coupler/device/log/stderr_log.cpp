// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/log/stderr_log.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <syslog.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <climits>
#include <csignal>
#include <cstdio>

#include "coupler/base/never_wait.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::device {
namespace {

constexpr std::string_view speaker = "coupler-node: ";

/// The variable is inherited by processes whose stderr leads elsewhere.
bool is_stderr(const char* stream) {
  struct stat now {};
  return stream != nullptr && ::fstat(STDERR_FILENO, &now) == 0 &&
         fmt::format("{}:{}", now.st_dev, now.st_ino) == stream;
}

bool takes_some(int fd) {
  pollfd wish{fd, POLLOUT, 0};
  return ::poll(&wish, 1, 0) == 1 && (wish.revents & POLLOUT) != 0;
}

}  // namespace

LogStream::LogStream() {
  struct stat now {};
  if (::fstat(STDERR_FILENO, &now) != 0) return;
  is_socket_ = S_ISSOCK(now.st_mode);
  own_ = Descriptor(open_again(STDERR_FILENO));
}

std::size_t LogStream::write(std::string_view text) const {
  std::size_t written = 0;
  while (written < text.size()) {
    const std::size_t more = write_some(text.substr(written, PIPE_BUF));
    if (more == 0) break;
    written += more;
  }
  return written;
}

/// A pipe that poll() calls writable has room for PIPE_BUF bytes (pipe(7): a whole page is free).
std::size_t LogStream::write_some(std::string_view text) const {
  ssize_t written = -1;
  if (is_socket_)
    written = ::send(STDERR_FILENO, text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  else if (own_.is_open())
    written = ::write(own_.get(), text.data(), text.size());
  else if (takes_some(STDERR_FILENO))
    written = ::write(STDERR_FILENO, text.data(), text.size());
  return written > 0 ? static_cast<std::size_t>(written) : 0;
}

StderrLog::StderrLog(const char* journal_stream) : to_journal_(is_stderr(journal_stream)) {}

void StderrLog::write(std::string_view line) { put(LOG_INFO, speaker, line); }
void StderrLog::warn(std::string_view line) { put(LOG_WARNING, speaker, line); }
void StderrLog::fail(std::string_view line) { put(LOG_ERR, speaker, line); }

void StderrLog::write_limited(std::string_view kind, std::string_view line) {
  put_limited(LOG_INFO, kind, line);
}

void StderrLog::warn_limited(std::string_view kind, std::string_view line) {
  put_limited(LOG_WARNING, kind, line);
}

void StderrLog::put_limited(int priority, std::string_view kind, std::string_view line) {
  if (!now_) return put(priority, speaker, line);
  Kind& of_kind = kinds_[std::string(kind)];
  of_kind.priority = priority;
  if (const auto said = of_kind.limit.say(std::string(line), *now_)) put(priority, speaker, *said);
}

std::optional<std::chrono::milliseconds> StderrLog::tick(TimePoint now) {
  using std::chrono::milliseconds;
  now_ = now;
  std::optional<TimePoint> next;
  for (auto& [name, kind] : kinds_) {
    if (const auto line = kind.limit.due(now)) put(kind.priority, speaker, *line);
    const auto due = kind.limit.due_at();
    if (due && (!next || *due < *next)) next = due;
  }
  if (!next) return std::nullopt;
  return std::max(milliseconds(0), std::chrono::ceil<milliseconds>(*next - now));
}

void StderrLog::tell(const Diagnostic& diagnostic) {
  const bool is_error = diagnostic.severity == Diagnostic::Severity::error;
  const std::string text = to_journal_ ? to_string(diagnostic) : render(diagnostic, Colour::no);
  put(is_error ? LOG_ERR : LOG_WARNING, "", text);
}

void StderrLog::never_wait() {
  waits_ = false;
  // A terminal with "stty tostop" stops the process of the background that writes.
  std::signal(SIGTTOU, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a log file that may not grow
}

void StderrLog::put(int priority, std::string_view who, std::string_view line) {
  const std::string text = line_of(priority, who, line);
  // Whoever read it may be gone: that is no reason to end.
  if (waits_)
    (void)std::fputs(text.c_str(), stderr);
  else if (!tell_dropped() || !write_at_once(text))
    ++dropped_[0].lines;
}

std::string StderrLog::line_of(int priority, std::string_view who, std::string_view line) const {
  const std::string shown = printable_lines(line);
  std::string text = to_journal_ ? fmt::format("<{}>{}", priority, shown) : fmt::format("{}{}", who, shown);
  if (text.back() != '\n') text += '\n';
  return text;
}

bool StderrLog::write_at_once(std::string_view text) {
  const std::size_t written = stream_.write(text);
  if (written > 0) dropped_[0].in_the_middle = written < text.size();
  return written == text.size();
}

bool StderrLog::tell_dropped() {
  const unsigned lines = dropped_[0].lines.exchange(0);
  if (lines == 0) return true;
  const std::string_view end_of_cut = dropped_[0].in_the_middle ? "\n" : "";
  const std::string what =
      fmt::format("{} line{} missing here: stderr was blocked", lines, lines == 1 ? " is" : "s are");
  if (write_at_once(fmt::format("{}{}", end_of_cut, line_of(LOG_WARNING, speaker, what)))) return true;
  dropped_[0].lines += lines;
  return false;
}

}  // namespace coupler::device
