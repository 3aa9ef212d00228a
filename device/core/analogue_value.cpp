// SPDX-License-Identifier: Apache-2.0
#include "device/core/analogue_value.hpp"

#include <limits>
#include <type_traits>

#include "common/codec/number.hpp"

namespace coupler::node {
namespace {

using codec::Type;

/// Calls `use` with a zero of the C++ type that the point's raw value has.
template <class Use>
auto with_type(Type type, Use use) {
  switch (type) {
    case Type::SINT: return use(std::int8_t{});
    case Type::INT: return use(std::int16_t{});
    case Type::UINT:
    case Type::WORD: return use(std::uint16_t{});
    case Type::DINT: return use(std::int32_t{});
    case Type::UDINT:
    case Type::DWORD: return use(std::uint32_t{});
    case Type::LINT: return use(std::int64_t{});
    case Type::ULINT:
    case Type::LWORD: return use(std::uint64_t{});
    case Type::REAL: return use(float{});
    case Type::LREAL: return use(double{});
    default: return use(std::uint8_t{});
  }
}

template <class T>
T nearest(double raw) {
  constexpr auto least = static_cast<double>(std::numeric_limits<T>::lowest());
  constexpr auto most = static_cast<double>(std::numeric_limits<T>::max());
  if (raw <= least) return std::numeric_limits<T>::lowest();
  if (raw >= most) return std::numeric_limits<T>::max();
  if constexpr (std::is_integral_v<T>) raw += raw < 0 ? -0.5 : 0.5;
  return static_cast<T>(raw);
}

}  // namespace

double value_in(const Point& point, const std::uint16_t* registers) {
  const double raw = with_type(point.format.type, [&](auto zero) -> double {
    using T = decltype(zero);
    if constexpr (sizeof(T) == 1)
      return static_cast<T>(codec::decode_part(*registers, point.format));
    else
      return static_cast<double>(codec::decode<T>(registers, point.format.order));
  });
  return raw * point.scale.gain + point.scale.offset;
}

void put_value(double value, const Point& point, std::uint16_t* registers) {
  const double raw = (value - point.scale.offset) / point.scale.gain;
  with_type(point.format.type, [&](auto zero) {
    using T = decltype(zero);
    if constexpr (sizeof(T) == 1) {
      const auto bits = codec::encode_part(static_cast<std::uint8_t>(nearest<T>(raw)), point.format);
      *registers = static_cast<std::uint16_t>((*registers & ~codec::mask(point.format)) | bits);
    } else {
      codec::encode(nearest<T>(raw), point.format.order, registers);
    }
  });
}

}  // namespace coupler::node
