// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/network.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include <fmt/format.h>

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

constexpr std::string_view digits = "0123456789";
constexpr std::string_view of_a_name = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._";

tl::unexpected<NetworkError> wrong(std::string what, std::string remedy) {
  return tl::unexpected<NetworkError>({std::move(what), std::move(remedy)});
}

bool is_made_of(std::string_view text, std::string_view characters) {
  return text.find_first_not_of(characters) == std::string_view::npos;
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

tl::expected<std::string_view, NetworkError> parse_host(std::string_view text) {
  constexpr const char* example =
      "write a host name or an IP address, as in plc7.local, 192.168.0.10 or fd00::7";
  if (text.empty()) return wrong("is empty", example);
  if (const auto scheme = text.find("://"); scheme != std::string_view::npos)
    return wrong("has a scheme", fmt::format("leave '{}' out", text.substr(0, scheme + 3)));
  const bool in_brackets = text.front() == '[' && text.back() == ']';
  const std::string_view host = in_brackets ? text.substr(1, text.size() - 2) : text;
  if (is_ip_address(host) && (!in_brackets || host.find(':') != std::string_view::npos)) return host;
  if (const auto colon = text.rfind(':'); colon != std::string_view::npos) {
    const std::string_view port = text.substr(colon + 1);
    if (!port.empty() && is_made_of(port, digits) && parse_host(text.substr(0, colon)))
      return wrong("has a port", fmt::format("write 'port: {}' beside it", port));
    return wrong("is not an IPv6 address", example);
  }
  if (is_made_of(text, "0123456789."))
    return wrong("is not an IP address", "write four numbers from 0 to 255, as in 192.168.0.10");
  if (!is_made_of(text, of_a_name) || text.front() == '.' || text.front() == '-')
    return wrong("is not a host name", example);
  return text;
}

}  // namespace coupler
