// SPDX-License-Identifier: Apache-2.0
#include "coupler/credentials/credentials.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "coupler/base/starts_with.hpp"

namespace coupler {
namespace {

constexpr off_t most_bytes = 1 << 20;

/// Closes it at its end.
class OpenFile {
 public:
  /// O_NONBLOCK: the other end of a pipe is not awaited.
  explicit OpenFile(const std::string& path)
      : fd_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK)) {}
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() {
    if (fd_ >= 0) ::close(fd_);
  }
  int get() const { return fd_; }

 private:
  int fd_;
};

bool is_systemd_credential(const std::string& path) {
  const char* folder = std::getenv("CREDENTIALS_DIRECTORY");
  return folder != nullptr && *folder != '\0' && starts_with(path, std::string(folder) + "/");
}

/// Returns what is wrong with the permissions of a key, and what to do.
std::optional<std::string> why_not_secret(const struct stat& file, const std::string& path) {
  const auto others = [&](const char* who, const char* what) {
    return fmt::format("{} may {} it; 'chmod 600 {}' keeps it to its owner", who, what, path);
  };
  if (::geteuid() == 0 && file.st_uid != 0 && !is_systemd_credential(path))
    return fmt::format(
        "it belongs to another user, who can exchange it; 'chown root {}' gives it to this one", path);
  if ((file.st_mode & S_IROTH) != 0) return others("everybody", "read");
  if ((file.st_mode & S_IWOTH) != 0) return others("everybody", "change");
  if ((file.st_mode & S_IWGRP) != 0) return others("its group", "change");
  const bool is_own_group = file.st_gid == ::getegid() || ::group_member(file.st_gid) != 0;
  if ((file.st_mode & S_IRGRP) != 0 && !is_own_group && !is_systemd_credential(path))
    return others("a group that this process is not in", "read");
  return std::nullopt;
}

std::string read_error(int error, std::string_view path, std::string_view folder) {
  if (error == EACCES)
    return fmt::format("{}; give it to the user that runs this program (id -un prints the name)",
                       std::strerror(error));
  if (error == ENOENT && !path.empty() && path.front() != '/')
    return fmt::format("{}; its path begins in {}", std::strerror(error),
                       folder.empty() ? "the working directory" : folder);
  return std::strerror(error);
}

}  // namespace

tl::expected<std::string, std::string> read_pem_file(std::string_view what, std::string_view path,
                                                     std::string_view folder, bool is_secret) {
  const std::string full = (std::filesystem::path(folder) / path).string();
  const auto failed = [&](const std::string& why) {
    return tl::unexpected(fmt::format("the {} {} {}", what, full, why));
  };
  const OpenFile file(full);
  struct stat status {};
  if (file.get() < 0 || ::fstat(file.get(), &status) != 0)
    return failed("cannot be read: " + read_error(errno, path, folder));
  if (!S_ISREG(status.st_mode)) return failed("is not a regular file; write it to one");
  if (status.st_size > most_bytes) return failed("is larger than 1 MiB; certificates are smaller");
  std::string text(static_cast<std::size_t>(status.st_size), '\0');
  std::size_t size = 0;
  while (size < text.size()) {
    const ssize_t got = ::read(file.get(), &text[size], text.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return failed("cannot be read: " + read_error(errno, path, folder));
    if (got == 0) break;  // it has become shorter
    size += static_cast<std::size_t>(got);
  }
  text.resize(size);
  if (is_secret && text.find("PRIVATE KEY") == std::string::npos &&
      text.find("BEGIN CERTIFICATE") != std::string::npos)
    return failed("is a certificate; perhaps 'certificate' and 'key' are swapped");
  if (is_secret)
    if (const auto why = why_not_secret(status, full)) return failed("is not secret: " + *why);
  return text;
}

tl::expected<Credentials, std::string> read_credentials(const CredentialFiles& files) {
  Credentials read;
  struct File {
    std::string_view what;
    std::string_view path;
    std::string& text;
    bool is_secret;
  };
  for (const File& file : {File{"certificate", files.certificate, read.certificate, false},
                           {"key", files.key, read.key, true},
                           {"authority's certificate", files.ca, read.ca, false},
                           {"list of revoked certificates", files.revoked, read.revoked, false}}) {
    if (file.path.empty()) continue;
    auto text = read_pem_file(file.what, file.path, files.folder, file.is_secret);
    if (!text) return tl::unexpected(std::move(text).error());
    // An empty list of revoked certificates would revoke none: it is one that is being written.
    if (text->empty())
      return tl::unexpected(
          fmt::format("the {} {} is empty; a copy of it may not be complete", file.what, file.path));
    file.text = *std::move(text);
  }
  return read;
}

}  // namespace coupler
