// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/tls_process/tls_settings.hpp"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace coupler::device {
namespace {

using Size = std::uint32_t;

void put(std::string& bytes, std::string_view text) {
  const auto size = static_cast<Size>(text.size());
  bytes.append(reinterpret_cast<const char*>(&size), sizeof size).append(text);
}

void put(std::string& bytes, const std::vector<std::string>& texts) {
  put(bytes, std::to_string(texts.size()));
  for (const std::string& text : texts) put(bytes, text);
}

/// Texts, one after the other. What is not there is empty, and makes it bad.
class Taker {
 public:
  explicit Taker(std::string_view bytes) : rest_(bytes) {}

  std::string text() {
    Size size = 0;
    is_good_ = is_good_ && rest_.size() >= sizeof size;
    if (!is_good_) return {};
    std::memcpy(&size, rest_.data(), sizeof size);
    rest_.remove_prefix(sizeof size);
    is_good_ = rest_.size() >= size;
    if (!is_good_) return {};
    std::string text(rest_.substr(0, size));
    rest_.remove_prefix(size);
    return text;
  }
  std::vector<std::string> texts() {
    std::vector<std::string> all;
    for (long count = std::strtol(text().c_str(), nullptr, 10); count > 0 && is_good_; --count)
      all.push_back(text());
    return all;
  }
  bool is_good() const { return is_good_; }

 private:
  std::string_view rest_;
  bool is_good_ = true;
};

}  // namespace

tl::expected<TlsSettings, std::string> tls_settings_of(const Map& map) {
  auto credentials = read_credentials(map.security.files);
  if (!credentials) return tl::unexpected(std::move(credentials).error());
  TlsSettings settings;
  settings.credentials = *std::move(credentials);
  settings.allow.assign(map.service.allow.begin(), map.service.allow.end());
  for (const Role& role : map.security.roles) settings.roles.emplace_back(role.name);
  return settings;
}

Descriptor make_settings_memory() { return Descriptor(::memfd_create("coupler-tls", MFD_CLOEXEC)); }

bool write_settings(int memory, const TlsSettings& settings) {
  std::string bytes;
  for (const std::string* text : {&settings.credentials.certificate, &settings.credentials.key,
                                  &settings.credentials.ca, &settings.credentials.revoked})
    put(bytes, *text);
  put(bytes, settings.allow);
  put(bytes, settings.roles);
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t size = ::pwrite(memory, &bytes[at], bytes.size() - at, static_cast<off_t>(at));
    if (size < 0 && errno != EINTR) return false;
    if (size > 0) at += static_cast<std::size_t>(size);
  }
  return true;
}

std::optional<TlsSettings> read_settings(int memory) {
  struct stat status {};
  if (::fstat(memory, &status) != 0) return std::nullopt;
  std::string bytes(static_cast<std::size_t>(status.st_size), '\0');
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t size = ::pread(memory, &bytes[at], bytes.size() - at, static_cast<off_t>(at));
    if (size <= 0) return std::nullopt;
    at += static_cast<std::size_t>(size);
  }
  Taker taker(bytes);
  TlsSettings settings;
  settings.credentials.certificate = taker.text();
  settings.credentials.key = taker.text();
  settings.credentials.ca = taker.text();
  settings.credentials.revoked = taker.text();
  settings.allow = taker.texts();
  settings.roles = taker.texts();
  if (!taker.is_good()) return std::nullopt;
  return settings;
}

}  // namespace coupler::device
