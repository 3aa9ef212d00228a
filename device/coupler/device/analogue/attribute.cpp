// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/analogue/attribute.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <fstream>

#include "coupler/base/starts_with.hpp"

namespace coupler::device {

tl::expected<Attribute, int> Attribute::open(const std::string& path, For purpose) {
  Descriptor file(::open(path.c_str(), (purpose == For::reading ? O_RDONLY : O_WRONLY) | O_CLOEXEC));
  if (!file.is_open()) return tl::unexpected(errno);
  return Attribute(std::move(file));
}

tl::expected<double, int> Attribute::read() const {
  std::array<char, 64> text{};
  const ssize_t size = ::pread(file_.get(), text.data(), text.size(), 0);
  if (size < 0) return tl::unexpected(errno);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + size, value);
  if (error != std::errc()) return tl::unexpected(EBADMSG);
  return value;
}

int Attribute::write(std::int64_t value) const {
  std::array<char, 24> text{};
  char* end = std::to_chars(text.data(), text.data() + text.size() - 1, value).ptr;
  *end++ = '\n';
  const auto size = static_cast<std::size_t>(end - text.data());
  return ::pwrite(file_.get(), text.data(), size, 0) < 0 ? errno : 0;
}

std::optional<std::string> read_text(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) return std::nullopt;
  return line;
}

tl::expected<double, int> read_number(const std::string& path) {
  const auto file = Attribute::open(path, Attribute::For::reading);
  if (!file) return tl::unexpected(file.error());
  return file->read();
}

std::vector<std::string> names_in(const std::string& folder, const std::string& prefix) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (std::string name = entry.path().filename(); starts_with(name, prefix)) names.push_back(name);
  std::sort(names.begin(), names.end(), [](const std::string& a, const std::string& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  });
  return names;
}

std::string remedy_for(int error, const std::string& path) {
  if (error == EACCES || error == EPERM)
    return fmt::format(
        "; run as a user who may use {} (the udev rules of the package coupler-node give it to the group "
        "gpio)",
        path);
  if (error == EROFS) return fmt::format("; let the service write to {} (ReadWritePaths= of its unit)", path);
  return {};
}

}  // namespace coupler::device
