// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/fingerprint.hpp"

#include <sha256.h>  // libmd

#include <array>
#include <cstdio>
#include <tuple>

#include <fmt/format.h>

#include "coupler/codec/text.hpp"

namespace coupler {
namespace {

/// Whole registers first, then halves, then bits, then numbers in some bits.
unsigned rank_of_part(const Point& point) {
  if (!is_partial(point)) return 0;
  if (point.format.bits != 0) return 19U + 16U * point.format.bit + point.format.bits;
  if (point.format.type == codec::Type::BOOL) return 3U + point.format.bit;
  return point.format.half == codec::Half::high ? 1 : 2;
}

auto sort_key(const Point& point) {
  return std::make_tuple(index(point.table), point.address, rank_of_part(point), point.name);
}

std::string part(const Point& point) {
  if (!is_partial(point)) return "-";
  if (const codec::Format& f = point.format; f.bits != 0)
    return fmt::format("bits{}-{}", f.bit, f.bit + f.bits - 1);
  if (point.format.type == codec::Type::BOOL) return fmt::format("bit{}", point.format.bit);
  return point.format.half == codec::Half::high ? "high" : "low";
}

std::string order(const Point& point) {
  if (holds_bits(point.table)) return "-";
  return std::string(codec::order_text(point.format));
}

/// By C's printf: fmt 10 and later write hexadecimal floats in another way.
std::string scale(const Point& point) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%a:%a", point.scale.gain, point.scale.offset);
  return point.scale.has_exponent() ? fmt::format("{}:{}", text.data(), point.scale.exponent_of)
                                    : text.data();
}

}  // namespace

std::uint64_t hash64(std::string_view text) {
  std::array<std::uint8_t, SHA256_DIGEST_LENGTH> digest{};
  SHA2_CTX context;
  SHA256Init(&context);
  SHA256Update(&context, reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  SHA256Final(digest.data(), &context);
  std::uint64_t first = 0;
  for (std::size_t i = 0; i < sizeof first; ++i) first = first << 8 | digest[i];
  return first;
}

bool canonical_less(const Point& a, const Point& b) { return sort_key(a) < sort_key(b); }

std::string canonical_line(const Point& point) {
  const bool text = point.format.type == codec::Type::STRING;
  return fmt::format("{} {} {} {} {} {} {} {} {} {} {} {}", to_string(point.table), point.address,
                     part(point), point.name, to_string(point.format.type), order(point), point.count,
                     text ? fmt::to_string(point.format.length) : "-",
                     text ? codec::to_string(point.format.encoding) : "-",
                     text ? (ignores_byte_order(point.format) ? "true" : "false") : "-", scale(point),
                     to_string(point.access));
}

std::string canonical_text(Span<const Point> sorted_points) {
  std::string text;
  for (const Point& point : sorted_points) text += canonical_line(point) + '\n';
  return text;
}

std::uint64_t fingerprint(Span<const Point> sorted_points) { return hash64(canonical_text(sorted_points)); }

std::string fingerprint_text(std::uint64_t fingerprint) { return fmt::format("{:016x}", fingerprint); }

}  // namespace coupler
