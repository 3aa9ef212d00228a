// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <type_traits>

#include "coupler/codec/number.hpp"
#include "coupler/test_vectors/elements.hpp"

namespace coupler::test_vectors {
namespace {

/// No byte is like another, and none is what reversed bytes would have there.
template <class T>
constexpr auto pattern() {
  using U = typename codec::detail::Unsigned<sizeof(T)>::type;
  if constexpr (sizeof(T) == 1)
    return U{0x5A};
  else
    return static_cast<U>(0x0123456789ABCDEFU >> (64 - 8 * sizeof(T)));
}

template <class T>
std::vector<T> telling() {
  using Ends = std::numeric_limits<T>;
  const auto shown = codec::detail::bit_cast<T>(pattern<T>());
  const auto inverse = codec::detail::bit_cast<T>(static_cast<decltype(pattern<T>())>(~pattern<T>()));
  if constexpr (std::is_floating_point_v<T>)
    return {T{0},
            T{1},
            T{-1.5},
            shown,
            inverse,
            Ends::lowest(),
            Ends::max(),
            Ends::min(),
            Ends::denorm_min(),
            -Ends::denorm_min(),
            -T{0},
            Ends::infinity(),
            -Ends::infinity(),
            Ends::quiet_NaN()};
  else if constexpr (std::is_signed_v<T>)
    return {T{0}, T{1}, T{-1}, shown, inverse, Ends::min(), Ends::max()};
  else
    return {T{0}, T{1}, shown, inverse, Ends::max()};
}

template <class T>
std::vector<codec::Value> next_to_the_ends() {
  using Ends = std::numeric_limits<T>;
  if constexpr (std::is_same_v<T, double>)
    return {};
  else if constexpr (std::is_same_v<T, float>)
    return {1e39, -1e39};
  else if constexpr (std::is_same_v<T, std::uint64_t>)
    return {std::int64_t{-1}};
  else if constexpr (std::is_same_v<T, std::int64_t>)
    return {static_cast<std::uint64_t>(Ends::max()) + 1};
  else
    return {std::int64_t{Ends::min()} - 1, std::int64_t{Ends::max()} + 1};
}

}  // namespace

std::vector<Element> number_elements(const codec::Format& format) {
  if (format.type == codec::Type::BOOL) return {{0}, {codec::mask(format)}};
  return codec::with_number(format.type, [&](auto zero) {
    std::vector<Element> elements;
    for (const auto value : telling<decltype(zero)>()) {
      elements.emplace_back(codec::registers(format));
      codec::put(value, format, elements.back().data());
    }
    return elements;
  });
}

std::vector<codec::Value> refused_numbers(codec::Type type) {
  if (type == codec::Type::BOOL) return {};
  return codec::with_number(type, [](auto zero) { return next_to_the_ends<decltype(zero)>(); });
}

std::vector<codec::Value> refused_scaled(codec::Type type, const codec::Scale& scale) {
  using Double = std::numeric_limits<double>;
  std::vector<codec::Value> values{Double::quiet_NaN(), Double::infinity(), -Double::infinity()};
  const auto [least, most] = codec::published_range(type, scale);
  const double width = most - least;
  if (most + width <= Double::max() && least - width >= Double::lowest()) {
    values.emplace_back(most + width);
    values.emplace_back(least - width);
  }
  return values;
}

}  // namespace coupler::test_vectors
