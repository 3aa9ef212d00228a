// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/network.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

namespace coupler {
namespace {

constexpr unsigned mapped_prefix = 96;

constexpr unsigned bit(const IpAddress& address, unsigned i) { return address[i / 8] >> (7 - i % 8) & 1U; }

bool is_ipv4(std::string_view text) { return text.find(':') == std::string_view::npos; }

std::optional<IpAddress> parse_address(std::string_view text) {
  const std::string terminated(text);
  IpAddress address{};
  if (!is_ipv4(text))
    return ::inet_pton(AF_INET6, terminated.c_str(), address.data()) == 1 ? std::optional(address)
                                                                          : std::nullopt;
  address[10] = 0xFF;
  address[11] = 0xFF;
  return ::inet_pton(AF_INET, terminated.c_str(), &address[12]) == 1 ? std::optional(address) : std::nullopt;
}

std::optional<unsigned> parse_prefix(std::string_view digits, unsigned most) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || value > most) return std::nullopt;
  return value;
}

IpAddress masked(IpAddress address, unsigned prefix) {
  for (unsigned i = prefix; i < 128; ++i)
    address[i / 8] = static_cast<std::uint8_t>(address[i / 8] & ~(0x80U >> i % 8));
  return address;
}

std::string to_text(const IpAddress& address, bool ipv4) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  ::inet_ntop(ipv4 ? AF_INET : AF_INET6, &address[ipv4 ? 12 : 0], text.data(), text.size());
  return text.data();
}

}  // namespace

bool is_ipv4(const IpAddress& address) {
  constexpr std::array<std::uint8_t, 12> mapped{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF};
  return std::equal(mapped.begin(), mapped.end(), address.begin());
}

bool Network::contains(const IpAddress& other) const {
  if (is_ipv4(address) != is_ipv4(other)) return false;
  for (unsigned i = 0; i < prefix; ++i)
    if (bit(address, i) != bit(other, i)) return false;
  return true;
}

bool Network::is_whole_family() const { return prefix == (is_ipv4(address) ? mapped_prefix : 0); }

bool is_ip_address(std::string_view text) {
  const std::size_t zone = is_ipv4(text) ? std::string_view::npos : text.find('%');
  return zone != text.size() - 1 && parse_address(text.substr(0, zone)).has_value();
}

tl::expected<Network, NetworkError> parse_network(std::string_view text) {
  const std::size_t slash = text.find('/');
  const bool ipv4 = is_ipv4(text);
  const auto address = parse_address(text.substr(0, slash));
  if (!address)
    return tl::unexpected(NetworkError{"is not an IP address",
                                       "write one as 10.0.0.7 or fd00::7, or a range as 192.168.0.0/24"});
  if (slash == std::string_view::npos) return Network{*address, 128};

  const unsigned most = ipv4 ? 32 : 128;
  const auto length = parse_prefix(text.substr(slash + 1), most);
  if (!length)
    return tl::unexpected(NetworkError{fmt::format("has no prefix length from 0 to {}", most),
                                       ipv4 ? "write it as in 192.168.0.0/24" : "write it as in fd00::/8"});
  const Network network{masked(*address, *length + (ipv4 ? mapped_prefix : 0)),
                        *length + (ipv4 ? mapped_prefix : 0)};
  if (network.address != *address) {
    const std::string range = to_text(network.address, ipv4);
    return tl::unexpected(NetworkError{fmt::format("is an address inside the range {}/{}", range, *length),
                                       fmt::format("write {}/{} for the range, or {} for the one address",
                                                   range, *length, text.substr(0, slash))});
  }
  return network;
}

}  // namespace coupler
