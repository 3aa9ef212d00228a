// SPDX-License-Identifier: Apache-2.0
// The values of vectors as the types of generated code, and back.
#pragma once

#include <array>
#include <cstring>
#include <type_traits>
#include <vector>

#include "coupler/codec/value.hpp"

namespace coupler::random {

/// point.count of them.
using Values = std::vector<codec::Value>;

template <class T>
struct Elements {
  static constexpr std::size_t count = 1;
  static Values values(const T& value) {
    if constexpr (std::is_same_v<T, char>)
      return {std::uint64_t{static_cast<unsigned char>(value)}};
    else if constexpr (!std::is_integral_v<T> || std::is_same_v<T, bool>)
      return {value};
    else if constexpr (std::is_signed_v<T>)
      return {std::int64_t{value}};
    else
      return {std::uint64_t{value}};
  }
  static T typed(const codec::Value* values) {
    if constexpr (!std::is_integral_v<T> || std::is_same_v<T, bool>)
      return std::get<T>(*values);
    else if constexpr (std::is_signed_v<T> && !std::is_same_v<T, char>)
      return static_cast<T>(std::get<std::int64_t>(*values));
    else
      return static_cast<T>(std::get<std::uint64_t>(*values));
  }
};

template <class T, std::size_t Count>
struct Elements<std::array<T, Count>> {
  static constexpr std::size_t count = Count;
  static Values values(const std::array<T, Count>& array) {
    Values all;
    for (const T& element : array) all.push_back(Elements<T>::values(element).front());
    return all;
  }
  static std::array<T, Count> typed(const codec::Value* values) {
    std::array<T, Count> array;
    for (T& element : array) element = Elements<T>::typed(values++);
    return array;
  }
};

/// NaN is NaN, and -0 is not 0.
inline bool same_bits(const codec::Value& a, const codec::Value& b) {
  if (a.index() != b.index()) return false;
  return std::visit(
      [&](const auto& left) {
        using T = std::decay_t<decltype(left)>;
        const auto& right = std::get<T>(b);
        if constexpr (std::is_floating_point_v<T>)
          return std::memcmp(&left, &right, sizeof left) == 0;
        else
          return left == right;
      },
      a);
}

inline bool same_bits(const Values& a, const Values& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!same_bits(a[i], b[i])) return false;
  return true;
}

inline std::string to_string(const Values& values) {
  std::string text;
  for (const codec::Value& value : values) text += (text.empty() ? "" : ", ") + codec::to_string(value);
  return text;
}

}  // namespace coupler::random
