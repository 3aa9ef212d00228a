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
#include <utility>

#include <fmt/format.h>

#include "coupler/credentials/credentials.hpp"
#include "coupler/credentials/validity.hpp"
#include "coupler/tls/issue.hpp"

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

/// Writes the file under the name that it has while it is being written. 0, or the errno of what failed.
int begin(const NewFile& file) {
  const int fd = ::open(unfinished(file.path).c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC,
                        file.is_secret ? 0600 : 0644);
  if (fd < 0) return errno;
  const int error = write_all(fd, file.text);
  ::close(fd);
  return error;
}

tl::unexpected<std::string> cannot_be_written(const fs::path& path, int error) {
  return tl::unexpected(fmt::format("{} cannot be written: {}", path.string(), std::strerror(error)));
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
  if (::access(path.c_str(), F_OK) == 0) return cannot_be_written(path, EEXIST);
  return replace({{path, text, is_secret}});
}

tl::expected<void, std::string> replace(const std::vector<NewFile>& files) {
  const auto failed = [&](const NewFile& file, int error) {
    for (const NewFile& each : files) ::unlink(unfinished(each.path).c_str());
    return cannot_be_written(file.path, error);
  };
  for (const NewFile& file : files)
    if (const int error = begin(file); error != 0) return failed(file, error);
  for (const NewFile& file : files)
    if (::rename(unfinished(file.path).c_str(), file.path.c_str()) != 0) return failed(file, errno);
  return {};
}

Stems stems_in(const fs::path& folder, const std::string& name, const char* ending) {
  Stems stems{std::nullopt, name};
  const auto is_taken = [&](const char* with) { return fs::exists(folder / (stems.next + with)); };
  for (int number = 2; is_taken(".pem") || is_taken(".key") || is_taken(".csr"); ++number) {
    if (is_taken(ending)) stems.newest = stems.next;
    stems.next = fmt::format("{}-{}", name, number);
  }
  return stems;
}

tl::expected<std::string, std::string> keep_former(const fs::path& folder, const std::string& stem,
                                                   const std::string& certificate) {
  const auto life = tls::validity_of(certificate);
  constexpr std::size_t date_size = 10;  // 2028-11-25
  const std::string dated =
      fmt::format("{}-until-{}", stem, minute_text(life.value_or(Validity{}).end).substr(0, date_size));
  std::string name = dated;
  for (int number = 2; fs::exists(folder / (name + ".pem")); ++number) {
    if (read_pem_file("certificate", name + ".pem", folder.string()) == certificate) return name;
    name = fmt::format("{}-{}", dated, number);
  }
  std::vector<NewFile> copies;
  if (fs::exists(folder / (stem + ".key"))) {
    auto key = read_pem_file("key", stem + ".key", folder.string(), true);
    if (!key) return key;
    copies.push_back({folder / (name + ".key"), *std::move(key), true});
  }
  copies.push_back({folder / (name + ".pem"), certificate, false});
  if (auto done = replace(copies); !done) return tl::unexpected(std::move(done).error());
  return name;
}

}  // namespace coupler::tools
