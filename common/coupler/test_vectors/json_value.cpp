// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <type_traits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "coupler/codec/value.hpp"
#include "coupler/test_vectors/json.hpp"

namespace coupler::test_vectors {
namespace {

template <class T>
std::string number(T value) {
  if (std::isnan(value)) return "\"nan\"";
  if (std::isinf(value)) return value < 0 ? "\"-inf\"" : "\"inf\"";
  return codec::decimal(value);
}

}  // namespace

std::string json(const codec::Value& value, codec::Type type) {
  return std::visit(
      [&](const auto& v) -> std::string {
        using T = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<T, std::string>)
          return nlohmann::json(v).dump();
        else if constexpr (std::is_floating_point_v<T>)
          return number(v);
        else
          return fmt::format(codec::width(type) == 64 ? "\"{}\"" : "{}", v);
      },
      value);
}

}  // namespace coupler::test_vectors
