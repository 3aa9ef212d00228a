// SPDX-License-Identifier: Apache-2.0
#include "coupler/generate/output.hpp"

#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>

#include <fmt/format.h>

namespace coupler::generate {
namespace {

namespace fs = std::filesystem;

bool holds(const fs::path& path, std::string_view content) {
  std::error_code failed;
  if (fs::file_size(path, failed) != content.size() || failed) return false;
  std::ifstream in(path, std::ios::binary);
  const std::string found{std::istreambuf_iterator<char>(in), {}};
  return in && found == content;
}

/// The file that `path` is, or would be: a symbolic link stays one, and what it leads to is replaced. A link
/// is read from its own folder, as the kernel does.
fs::path target_of(fs::path path, std::error_code& failed) {
  constexpr int most_links = 40;  // as Linux follows
  for (int links = 0; fs::is_symlink(fs::symlink_status(path, failed)); ++links) {
    if (links == most_links) {
      failed = std::make_error_code(std::errc::too_many_symbolic_link_levels);
      return path;
    }
    path = path.parent_path() / fs::read_symlink(path, failed);
  }
  if (failed == std::errc::no_such_file_or_directory) failed.clear();
  return path;
}

/// The error is that of the system.
std::error_code write(const fs::path& path, std::string_view content) {
  errno = 0;
  std::ofstream out(path, std::ios::binary);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  if (out) return {};
  return {errno != 0 ? errno : EIO, std::generic_category()};
}

/// `path` is not a link. A file that is there keeps who may read and write it.
std::error_code replace(const fs::path& path, fs::file_status there, std::string_view content) {
  // Two builds may generate into one folder at the same time: each has its own temporary file.
  const fs::path temporary = fmt::format("{}.{}.new", path.string(), ::getpid());
  std::error_code failed = write(temporary, content);
  if (!failed && fs::is_regular_file(there)) fs::permissions(temporary, there.permissions(), failed);
  if (!failed) fs::rename(temporary, path, failed);
  if (failed) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
  }
  return failed;
}

tl::unexpected<std::string> cannot_write(const fs::path& path, const std::error_code& why) {
  return tl::unexpected(fmt::format("cannot write {}: {}", path.string(), why.message()));
}

}  // namespace

tl::expected<Outcome, std::string> write_if_changed(const fs::path& path, std::string_view content) {
  if (holds(path, content)) return Outcome::unchanged;
  std::error_code failed;
  const fs::file_status there = fs::status(path, failed);
  if (fs::is_other(there)) {  // a pipe or a device, such as /dev/stdout: it stays, too
    failed = write(path, content);
  } else {
    const fs::path target = target_of(path, failed);
    if (!failed) failed = replace(target, there, content);
  }
  if (failed) return cannot_write(path, failed);
  return Outcome::written;
}

}  // namespace coupler::generate
