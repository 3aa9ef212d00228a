// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/host.hpp"

#include <fmt/format.h>

#include "coupler/map/network.hpp"

namespace coupler {
namespace {

constexpr std::string_view digits = "0123456789";
constexpr std::string_view of_a_name = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._";

tl::unexpected<HostError> wrong(std::string what, std::string remedy) {
  return tl::unexpected<HostError>({std::move(what), std::move(remedy)});
}

bool is_made_of(std::string_view text, std::string_view characters) {
  return text.find_first_not_of(characters) == std::string_view::npos;
}

}  // namespace

tl::expected<std::string_view, HostError> parse_host(std::string_view text) {
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
      return wrong("has a port", fmt::format("say 'port: {}' beside it", port));
    return wrong("is not an IPv6 address", example);
  }
  if (is_made_of(text, "0123456789."))
    return wrong("is not an IP address", "write four numbers from 0 to 255, as in 192.168.0.10");
  if (!is_made_of(text, of_a_name) || text.front() == '.' || text.front() == '-')
    return wrong("is not a host name", example);
  return text;
}

}  // namespace coupler
