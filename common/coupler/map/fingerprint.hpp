// SPDX-License-Identifier: Apache-2.0
// The fingerprint of a map: what both sides of a connection must agree on, in 64 bits. docs/identity.md has
// the grammar with examples.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "coupler/base/span.hpp"
#include "coupler/map/point.hpp"

namespace coupler {

/// The first 64 bits, most significant first, of the text's SHA-256.
std::uint64_t hash64(std::string_view text);

/// The order of the points: table, address, part of the register (whole, high, low, bit 0 … 15), name.
bool canonical_less(const Point& a, const Point& b);

/// The point's line of the canonical text, without the newline:
///   TABLE ADDRESS PART NAME TYPE ORDER COUNT LENGTH ENCODING IGNORE_BYTEORDER SCALE ACCESS
/// separated by single spaces, "-" where a field does not apply, as in
///   holding_registers 40012 - name STRING BA 1 12 utf-8 false 0x1p+0:0x0p+0 read_write
std::string canonical_line(const Point& point);

/// All lines in the order of canonical_less(), each ended by "\n".
std::string canonical_text(Span<const Point> sorted_points);

/// hash64() of the canonical text.
std::uint64_t fingerprint(Span<const Point> sorted_points);

/// Sixteen lower-case hexadecimal digits.
std::string fingerprint_text(std::uint64_t fingerprint);

/// CRC-32 as in IEEE 802.3, zlib and PNG: reflected polynomial 0xEDB88320, initial and final value
/// 0xFFFFFFFF. crc32("123456789") is 0xCBF43926.
constexpr std::uint32_t crc32(std::string_view bytes) {
  std::uint32_t crc = 0xFFFFFFFF;
  for (const char byte : bytes) {
    crc ^= static_cast<std::uint8_t>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

}  // namespace coupler
