// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/certificate_files.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

namespace coupler::tools {
namespace {

namespace fs = std::filesystem;

/// Returns the path of a file while it is being written. No certificate's name begins with a dot.
fs::path unfinished(const fs::path& path) { return path.parent_path() / ("." + path.filename().string()); }

void delete_unfinished(const fs::path& folder) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const fs::path ending = entry.path().extension();
    const bool is_of_ours = ending == ".pem" || ending == ".key" || ending == ".csr";
    if (is_of_ours && entry.path().filename().string().front() == '.') fs::remove(entry.path(), ignored);
  }
}

/// 0, or the errno of what failed.
int write_all(int fd, std::string_view text) {
  while (!text.empty()) {
    const ssize_t size = ::write(fd, text.data(), text.size());
    if (size < 0) return errno;
    text.remove_prefix(static_cast<std::size_t>(size));
  }
  return ::fsync(fd) == 0 ? 0 : errno;
}

}  // namespace

tl::expected<void, std::string> make_folder(const fs::path& folder, bool is_secret) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && is_secret) fs::permissions(folder, fs::perms::owner_all, error);
  if (error) return tl::unexpected(fmt::format("{} cannot be made: {}", folder.string(), error.message()));
  delete_unfinished(folder);
  return {};
}

tl::expected<void, std::string> lock_folder(const fs::path& folder) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0)
    return tl::unexpected(fmt::format("{} cannot be opened: {}", folder.string(), std::strerror(errno)));
  if (::flock(fd, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return {};  // some file systems have none
  return tl::unexpected(fmt::format(
      "{}: another 'coupler certificates' works there; call this one when it has ended", folder.string()));
}

tl::expected<void, std::string> write_new(const fs::path& path, const std::string& text, bool is_secret) {
  const fs::path beginning = unfinished(path);
  const int fd = ::open(beginning.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, is_secret ? 0600 : 0644);
  int error = fd < 0 ? errno : write_all(fd, text);
  if (fd >= 0) ::close(fd);
  if (error == 0 && ::access(path.c_str(), F_OK) == 0) error = EEXIST;
  if (error == 0 && ::rename(beginning.c_str(), path.c_str()) != 0) error = errno;
  if (error == 0) return {};
  ::unlink(beginning.c_str());
  return tl::unexpected(fmt::format("{} cannot be written: {}", path.string(), std::strerror(error)));
}

}  // namespace coupler::tools
