// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/record/record_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "coupler/base/starts_with.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::host {
namespace {

namespace fs = std::filesystem;
using Problem = tl::unexpected<std::string>;

constexpr std::uint64_t smallest_share = 64 << 10;
/// So many files are kept at least, so that little is lost when the oldest is deleted.
constexpr std::uint64_t shares = 8;

bool is_recording(const fs::path& path) {
  std::error_code ignored;
  std::ifstream file;
  if (fs::is_regular_file(path, ignored)) file.open(path);
  if (!file.is_open()) return false;
  std::string first(16, '\0');
  file.read(first.data(), static_cast<std::streamsize>(first.size()));
  // A machine that lost its power may have left zeros.
  return file.gcount() == 0 || first[0] == '\0' || starts_with(first, "{\"record\":") ||
         starts_with(first, "t,utc,point,");
}

fs::path numbered(const fs::path& path, std::uint64_t number) {
  return path.parent_path() / fmt::format("{}.{}{}", path.stem().string(), number, path.extension().string());
}

/// Those before, by number.
std::map<std::uint64_t, fs::path> former(const fs::path& path) {
  std::map<std::uint64_t, fs::path> found;
  const std::string front = path.stem().string() + '.';
  const std::string back = path.extension().string();
  std::error_code ignored;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  constexpr std::ptrdiff_t most_digits = 7;  // more are a date, somebody's own
  for (fs::directory_iterator entry(folder, ignored); entry != fs::directory_iterator();
       entry.increment(ignored)) {
    const std::string name = entry->path().filename().string();
    if (name.size() <= front.size() + back.size() || !starts_with(name, front) ||
        name.compare(name.size() - back.size(), back.size(), back) != 0)
      continue;
    std::uint64_t number = 0;
    const char* const end = name.data() + name.size() - back.size();
    const auto parsed = std::from_chars(name.data() + front.size(), end, number);
    if (parsed.ec == std::errc() && parsed.ptr == end && number > 0 &&
        end - (name.data() + front.size()) <= most_digits && is_recording(entry->path()))
      found.emplace(number, entry->path());
  }
  return found;
}

/// Another process has the lock that create() takes.
bool is_being_written(const fs::path& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return false;
  const bool is_locked = ::flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(fd);
  return is_locked;
}

bool is_full_disk(int error) { return error == ENOSPC || error == EDQUOT; }

std::string problem_text(const fs::path& path, int error) {
  return fmt::format("{}: {}", path.string(), std::strerror(error));
}

}  // namespace

RecordFile::RecordFile(fs::path path, Limits limits) : path_(std::move(path)), limits_(limits) {}

RecordFile::RecordFile(RecordFile&& other) noexcept
    : path_(std::move(other.path_)),
      limits_(other.limits_),
      share_(other.share_),
      is_stream_(other.is_stream_),
      fd_(std::exchange(other.fd_, -1)),
      size_(other.size_),
      begin_size_(other.begin_size_),
      written_(other.written_) {}

RecordFile::~RecordFile() { close(); }

void RecordFile::close() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

tl::expected<RecordFile, std::string> RecordFile::open(fs::path path, Limits limits) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status))
    return Problem(path.string() + " is not a file; name one (`-o -` is standard output)");
  if (fs::exists(status) && ::access(path.c_str(), R_OK | W_OK) != 0)
    return Problem(problem_text(path, errno) + "; name another file");
  if (fs::exists(status) && !is_recording(path))
    return Problem(path.string() + " is there, and is no recording; name another file");
  if (is_being_written(path))
    return Problem(path.string() + " is being written by another program; name another file");
  RecordFile file(std::move(path), limits);
  if (auto created = file.create(); !created) return Problem(std::move(created).error());
  return file;
}

RecordFile RecordFile::standard_output() {
  RecordFile file("-", {});
  file.is_stream_ = true;
  file.fd_ = ::dup(STDOUT_FILENO);
  return file;
}

/// Moves what has the name out of the way.
tl::expected<void, std::string> RecordFile::create() {
  close();
  size_ = 0;
  std::error_code error;
  if (fs::exists(path_, error) && fs::file_size(path_, error) > 0) {
    const auto before = former(path_);
    std::uint64_t number = before.empty() ? 1 : before.rbegin()->first + 1;
    while (fs::exists(numbered(path_, number), error)) ++number;  // what is no recording stays
    fs::rename(path_, numbered(path_, number), error);
    if (error) return Problem(problem_text(path_, error.value()));
  }
  fd_ =
      ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, S_IRUSR | S_IWUSR | S_IRGRP);
  if (fd_ < 0) return Problem(problem_text(path_, errno));
  (void)::fchmod(fd_, S_IRUSR | S_IWUSR | S_IRGRP);  // it may have been there, empty
  (void)::flock(fd_, LOCK_EX | LOCK_NB);             // some network file systems have none
  return {};
}

tl::expected<void, std::string> RecordFile::begin(std::string_view lines) {
  if (size_ > 0 && !is_stream_)
    if (auto created = create(); !created) return created;
  if (!is_stream_) share_ = share();
  auto done = append(lines, 1);  // not what has just got its number
  begin_size_ = size_;
  if (done && !is_stream_) delete_what_is_too_much();
  return done;
}

tl::expected<void, std::string> RecordFile::write(std::string_view lines) { return append(lines, 0); }

/// `kept`: so many of those before are not deleted to make room.
tl::expected<void, std::string> RecordFile::append(std::string_view lines, std::size_t kept) {
  if (fd_ < 0)
    if (auto created = create(); !created) return created;
  std::string escaped;  // a terminal would obey the texts of a device
  if (is_stream_ && ::isatty(fd_) == 1) lines = escaped = printable_lines(lines);
  int error = write_all(lines);
  while (is_full_disk(error) && !is_stream_ && delete_oldest(kept)) error = write_all(lines);
  if (error != 0) return Problem(problem_text(path_, error));
  size_ += lines.size();
  written_ += lines.size();
  return {};
}

/// 0, or the errno of what failed: then nothing of it is in the file.
int RecordFile::write_all(std::string_view lines) {
  int error = 0;
  for (std::string_view rest = lines; !rest.empty() && error == 0;) {
    const ssize_t size = ::write(fd_, rest.data(), rest.size());
    if (size >= 0)
      rest.remove_prefix(static_cast<std::size_t>(size));
    else if (errno != EINTR)
      error = errno;
  }
  if (error == 0 && limits_.sync && ::fdatasync(fd_) != 0) error = errno;
  if (error != 0 && !is_stream_ && ::ftruncate(fd_, static_cast<off_t>(size_)) != 0)
    close();  // what follows goes to another file
  return error;
}

/// Returns a share of what is kept, or of the space that a small disk has: one file that fills the disk could
/// not make room for the next.
std::uint64_t RecordFile::share() const {
  std::uint64_t most = limits_.keep;
  std::error_code error;
  const fs::path folder = path_.parent_path();
  const fs::space_info disk = fs::space(folder.empty() ? "." : folder, error);
  if (!error) {
    std::uint64_t own = 0;
    for (const auto& [number, file] : former(path_))
      if (const auto size = fs::file_size(file, error); !error) own += size;
    most = std::min<std::uint64_t>(most, disk.available + own);
  }
  return std::clamp(most / shares, smallest_share, largest_share);
}

bool RecordFile::delete_oldest(std::size_t kept) {
  const auto all = former(path_);
  std::error_code error;
  return all.size() > kept && fs::remove(all.begin()->second, error);
}

void RecordFile::delete_what_is_too_much() {
  std::error_code ignored;
  std::uint64_t sum = share_;  // what this one is to become
  const auto all = former(path_);
  for (auto newest = all.rbegin(); newest != all.rend(); ++newest) {
    sum += fs::file_size(newest->second, ignored);
    if (sum > limits_.keep) fs::remove(newest->second, ignored);
  }
}

}  // namespace coupler::host
