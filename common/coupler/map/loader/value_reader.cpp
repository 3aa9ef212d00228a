// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/point_keys.hpp"

#include <fmt/format.h>

#include "coupler/codec/value.hpp"
#include "coupler/map/loader/scalar.hpp"

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

/// One value, at `registers`. False if it is wrong.
class ValueWriter {
 public:
  ValueWriter(std::string_view key, const Point& point, Context& context)
      : key_(key), point_(point), context_(context) {}

  bool write(const Entry& entry, std::uint16_t* registers) const {
    return point_.scale.present() ? write_scaled(entry, registers) : write_plain(entry, registers);
  }

 private:
  bool wrong(const Entry& entry, const std::string& wanted) const {
    context_.problems.error(entry.at,
                            fmt::format("'{}' of type {} is {}, not {}", key_, to_string(point_.format.type),
                                        wanted, shown(entry)),
                            "write " + wanted);
    return false;
  }

  bool write_plain(const Entry& entry, std::uint16_t* registers) const {
    const auto value = value_of(entry, point_.format.type);
    if (!value) return wrong(entry, expected(point_.format.type));
    if (const auto encoded = codec::encode(*value, point_.format, registers); !encoded) {
      context_.problems.error(entry.at, fmt::format("'{}': {}", key_, encoded.error()),
                              "write a value that the type can hold");
      return false;
    }
    return true;
  }

  bool write_scaled(const Entry& entry, std::uint16_t* registers) const {
    const bool bare = entry.kind == Entry::Kind::scalar && !entry.quoted;
    const auto value = bare ? parse_number(entry.text) : std::nullopt;
    if (!value) return wrong(entry, "a number, as it is published");
    if (codec::encode_published(*value, point_.format, point_.scale, registers) == codec::ScaleError::none)
      return true;
    const auto range = codec::published_range(point_.format.type, point_.scale);
    context_.problems.error(
        entry.at,
        fmt::format("'{}': {} is published from {:.15g} to {:.15g}, so {} cannot be written", key_,
                    shown(point_.name), range.least, range.most, entry.text),
        "write a value in that range, or change 'scale'");
    return false;
  }

  std::string_view key_;
  const Point& point_;
  Context& context_;
};

}  // namespace

Span<const std::uint16_t> read_value(std::string_view key, const Entry& entry, const Point& point,
                                     Context& context) {
  const ValueWriter writer(key, point, context);
  const std::size_t step = codec::registers(point.format);
  std::vector<std::uint16_t> registers(point.count * step);
  const bool list = point.count > 1 && entry.kind == Entry::Kind::list;
  if (list && entry.children.size() != point.count) {
    context.problems.error(
        entry.at,
        fmt::format("'{}' lists {} values, the array has {}", key, entry.children.size(), point.count),
        "write one for each, or a single one for all");
    return {};
  }
  for (std::size_t i = 0; i < point.count; ++i)
    if (!writer.write(list ? entry.children[i] : entry, &registers[i * step])) return {};
  return context.map.keep(registers);
}

}  // namespace coupler::loader
