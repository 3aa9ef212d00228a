// SPDX-License-Identifier: Apache-2.0
// Who may read and write what of a node, and what proves who somebody is. Roles are those of "MODBUS/TCP
// Security" (MBTPS 8.3); that their rights are given point by point is this project's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "coupler/base/span.hpp"

namespace coupler {

constexpr std::uint16_t default_tls_port = 802;  ///< MBTPS 4
constexpr std::size_t most_roles = 100;          ///< each has its rights for every point
constexpr std::size_t longest_role_name = 64;    ///< bytes of UTF-8, as in a certificate

/// Bits: what can be done with a point.
enum class Right : std::uint8_t { read = 1, write = 2 };

/// The rights of the clients of one role.
struct Role {
  std::string_view name;
  Span<const std::uint8_t> rights{};  ///< bits of Right for each of Map::points, in their order
  bool reads_all = false;             ///< every point that can be read, and what shows all of them

  constexpr bool may(Right right, std::size_t point) const {
    return (rights[point] & static_cast<std::uint8_t>(right)) != 0;
  }
};

/// Files of PEM text (RFC 7468).
struct CredentialFiles {
  std::string_view certificate{};  ///< its own, with those that lead to an authority; empty: no TLS
  std::string_view key{};          ///< of the certificate
  std::string_view ca{};           ///< the authorities whose certificates are believed
  std::string_view revoked{};      ///< their lists of what they have revoked; may be empty
  std::string_view folder{};       ///< where the paths begin, that of the map; empty: the working directory

  constexpr bool present() const { return !certificate.empty(); }
};

/// How a node is secured. Where it is not, everybody may do everything.
struct Security {
  Span<const Role> roles{};
  std::optional<std::uint16_t> plain{};    ///< the role of clients without TLS; nullopt: they may do nothing
  std::optional<std::uint16_t> no_role{};  ///< of those with TLS whose certificate has none of the roles
  CredentialFiles files{};                 ///< empty: it does not listen for TLS
  std::uint16_t port = default_tls_port;

  constexpr bool present() const { return !roles.empty() || files.present(); }
  /// Returns the rights of a client with TLS; nullptr if it has none. `name` is the role in its certificate;
  /// empty if it has none.
  constexpr const Role* role_of(std::string_view name) const {
    for (const Role& role : roles)
      if (role.name == name) return &role;
    return no_role ? &roles[*no_role] : nullptr;
  }
  /// Returns the rights of clients without TLS; nullptr if they have none.
  constexpr const Role* plain_role() const { return plain ? &roles[*plain] : nullptr; }
};

/// How a client proves itself to a device, and the device to it (Modbus/TCP Security).
struct Tls {
  std::string_view certificate{};
  std::string_view key{};
  std::string_view ca{};
  std::string_view name{};    ///< that the device's certificate must have; empty: the address
  std::string_view pin{};     ///< "sha256:…" of the device's certificate, in place of `ca` and `name`
  std::string_view folder{};  ///< as CredentialFiles::folder

  constexpr bool present() const { return !certificate.empty(); }
  friend constexpr bool operator==(const Tls& a, const Tls& b) {
    return a.certificate == b.certificate && a.key == b.key && a.ca == b.ca && a.name == b.name &&
           a.pin == b.pin;  // where it was read from has no meaning
  }
  friend constexpr bool operator!=(const Tls& a, const Tls& b) { return !(a == b); }
};

/// "sha256:" and 64 hexadecimal digits; colons may stand between them.
constexpr bool is_pin(std::string_view text) {
  constexpr std::string_view head = "sha256:";
  if (text.substr(0, head.size()) != head) return false;
  std::size_t digits = 0;
  for (const char c : text.substr(head.size())) {
    if (c == ':') continue;
    if (!((c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'))) return false;
    ++digits;
  }
  return digits == 64;
}

/// The key that is missing for TLS; empty: none is, or there is no TLS.
constexpr std::string_view missing_key(const Tls& tls) {
  const bool has_authority = !tls.ca.empty() || !tls.pin.empty();
  if (tls.certificate.empty()) return tls.key.empty() && !has_authority ? "" : "certificate";
  if (tls.key.empty()) return "key";
  return has_authority ? "" : "ca";
}

}  // namespace coupler
