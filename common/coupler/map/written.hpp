// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>

#include "coupler/base/enumeration.hpp"

namespace coupler {

/// A value as a map writes it.
inline std::string written(std::string_view text) { return std::string(text); }
inline std::string written(std::chrono::milliseconds duration) {
  return fmt::format("{}ms", duration.count());
}
inline std::string written(std::chrono::microseconds duration) {
  return fmt::format("{}us", duration.count());
}
template <class T>
std::enable_if_t<std::is_arithmetic_v<T> || std::is_enum_v<T>, std::string> written(T value) {
  if constexpr (std::is_enum_v<T>)
    return std::string(to_string(value));
  else
    return fmt::to_string(value);
}

}  // namespace coupler
