// SPDX-License-Identifier: Apache-2.0
#include "coupler/credentials/role_extension.hpp"

#include "coupler/codec/text.hpp"
#include "coupler/map/security.hpp"

namespace coupler {

/// A length below 128 is one byte in DER (X.690 10.1), and a role has no other.
tl::expected<std::string_view, std::string_view> parse_role(Span<const std::uint8_t> extension) {
  constexpr std::uint8_t utf8_string = 0x0C;  // X.690 8.23, universal class, primitive
  constexpr std::size_t head = 2;
  static_assert(longest_role_name < 0x80);
  if (extension.size() < head || extension[0] != utf8_string)
    return tl::unexpected(std::string_view("its role is not an ASN.1 UTF8String"));
  const std::size_t size = extension[1];
  if (size > longest_role_name) return tl::unexpected(std::string_view("its role has more than 64 bytes"));
  if (size != extension.size() - head)
    return tl::unexpected(std::string_view("its role does not fill its extension"));
  if (size == 0) return tl::unexpected(std::string_view("its role is empty"));
  const std::string_view role(reinterpret_cast<const char*>(extension.data()) + head, size);
  if (!codec::is_plain_text(role))
    return tl::unexpected(std::string_view("its role is not UTF-8, or has a control character"));
  return role;
}

}  // namespace coupler
