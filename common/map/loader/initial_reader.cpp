// SPDX-License-Identifier: Apache-2.0
#include "common/map/loader/initial_reader.hpp"

#include <fmt/format.h>

#include "common/codec/value.hpp"
#include "common/map/loader/scalar.hpp"

namespace coupler::loader {
namespace {

using codec::Type;
using codec::Value;

bool is_bit_string(Type type) {
  return type == Type::BYTE || type == Type::WORD || type == Type::DWORD || type == Type::LWORD;
}

std::string expected(Type type) {
  if (type == Type::BOOL) return "on or off";
  if (type == Type::STRING) return "text";
  if (is_bit_string(type))
    return fmt::format("a number or a list of {} times true or false", codec::width(type));
  return "a number";
}

/// Element i is bit i.
std::optional<Value> bits(const Entry& list, Type type) {
  if (!is_bit_string(type) || list.children.size() != codec::width(type)) return std::nullopt;
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < list.children.size(); ++i) {
    const Entry& element = list.children[i];
    const auto on = element.kind == Entry::Kind::scalar ? parse_boolean(element.text) : std::nullopt;
    if (!on) return std::nullopt;
    if (*on) value |= std::uint64_t{1} << i;
  }
  return value;
}

std::optional<Value> number(const Entry& scalar) {
  if (scalar.quoted) return std::nullopt;
  if (const auto value = parse_unsigned(scalar.text)) return *value;
  if (const auto value = parse_integer(scalar.text)) return *value;
  if (const auto value = parse_number(scalar.text)) return *value;
  return std::nullopt;
}

std::optional<Value> value_of(const Entry& entry, Type type) {
  if (entry.kind == Entry::Kind::list) return bits(entry, type);
  if (entry.kind != Entry::Kind::scalar) return std::nullopt;
  if (type == Type::STRING) return entry.text;
  if (type != Type::BOOL) return number(entry);
  if (const auto on = parse_boolean(entry.text)) return *on;
  return std::nullopt;
}

}  // namespace

void read_initial(const Reader& reader, Point& point, Context& context) {
  const Entry* entry = reader.find("initial");
  if (entry == nullptr) return;
  const auto value = value_of(*entry, point.format.type);
  if (!value) {
    const std::string wanted = expected(point.format.type);
    context.problems.error(entry->at,
                           fmt::format("'initial' of type {} is {}, not {}", to_string(point.format.type),
                                       wanted, shown(*entry)),
                           "write " + wanted);
    return;
  }
  std::vector<std::uint16_t> registers(codec::registers(point.format));
  if (const auto encoded = codec::encode(*value, point.format, registers.data()); !encoded) {
    context.problems.error(entry->at, "'initial': " + encoded.error(),
                           "write a value that the type can hold");
    return;
  }
  point.initial = context.map.keep(std::move(registers));
}

}  // namespace coupler::loader
