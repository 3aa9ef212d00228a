// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/access.hpp"

#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>

#include <fmt/format.h>

#include "coupler/base/lower.hpp"
#include "coupler/base/starts_with.hpp"

namespace coupler::host {

std::string random_key() {
  std::array<std::uint8_t, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw std::runtime_error("the system has no random numbers");
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

bool equal_in_constant_time(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned different = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    different |= static_cast<unsigned>(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
  return different == 0;
}

std::string Access::trade(std::string_view key) {
  if (!equal_in_constant_time(key, key_)) return {};
  std::string token = random_key();
  const std::lock_guard lock(mutex_);
  if (pages_.size() >= most_tokens) pages_.pop_front();
  pages_.push_back({token, ++given_});
  return token;
}

std::optional<Access::Page> Access::find(std::string_view authorization) {
  constexpr std::string_view scheme = "Bearer ";
  if (!starts_with(authorization, scheme)) return std::nullopt;
  const std::string_view shown = authorization.substr(scheme.size());
  const std::lock_guard lock(mutex_);
  auto found = pages_.end();
  for (auto page = pages_.begin(); page != pages_.end(); ++page)
    if (equal_in_constant_time(shown, page->token)) found = page;
  if (found == pages_.end()) return std::nullopt;
  std::rotate(found, found + 1, pages_.end());
  return pages_.back();
}

bool is_own_page(std::string_view host, std::string_view origin, std::string_view local, int port,
                 std::string_view name, bool secure) {
  const std::string scheme = secure ? "https://" : "http://";
  const int usual_port = secure ? 443 : 80;
  constexpr std::string_view mapped = "::ffff:";  // of IPv4, as a socket of IPv6 shows it
  if (starts_with(local, mapped) && local.find('.') != std::string_view::npos)
    local.remove_prefix(mapped.size());
  const std::string bracketed =
      local.find(':') == std::string_view::npos ? std::string(local) : fmt::format("[{}]", local);
  for (const std::string& own : {bracketed, std::string("localhost"), std::string(name)}) {
    if (own.empty()) continue;
    const std::string with_port = fmt::format("{}:{}", lower(own), port);
    const std::string asked = lower(host);
    const bool is_host = asked == with_port || (port == usual_port && asked == lower(own));
    if (is_host && (origin.empty() || lower(origin) == scheme + asked)) return true;
  }
  return false;
}

}  // namespace coupler::host
