// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/ros_message.hpp"

#include <string_view>

namespace coupler::docs {
namespace {

/// Of std_msgs; empty: bits, which are an array of this project's own.
std::string_view value_name(codec::Type type) {
  using codec::Type;
  switch (type) {
    case Type::BOOL: return "Bool";
    case Type::BYTE:
    case Type::WORD:
    case Type::DWORD:
    case Type::LWORD: return {};
    case Type::SINT: return "Int8";
    case Type::INT: return "Int16";
    case Type::DINT: return "Int32";
    case Type::LINT: return "Int64";
    case Type::USINT: return "UInt8";
    case Type::UINT: return "UInt16";
    case Type::UDINT: return "UInt32";
    case Type::ULINT: return "UInt64";
    case Type::REAL: return "Float32";
    case Type::LREAL: return "Float64";
    case Type::CHAR: return "Char";
    case Type::STRING: return "String";
  }
  return {};
}

}  // namespace

std::string ros_message(const Point& point) {
  const bool several = point.count > 1;
  const std::string_view name = point.scale.present() ? "Float64" : value_name(point.format.type);
  if (name.empty() || (several && name == "Bool")) return "coupler_driver/BoolArray";
  return "std_msgs/" + std::string(name) + (several ? "MultiArray" : "");
}

}  // namespace coupler::docs
