// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "coupler/codec/bit_string.hpp"
#include "coupler/map/loader/point_reader.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/typed_value.hpp"

namespace coupler::loader {
namespace {

using codec::Format;
using codec::Order;
using codec::Type;

bool is_text(Type type) { return type == Type::STRING; }
bool is_byte(Type type) { return codec::width(type) == 8; }
bool is_bit(Type type) { return type == Type::BOOL; }

/// Returns what to do when a type needs the key.
std::string missing(std::string_view key) {
  if (key == "offset") return "add 'offset: high' or 'offset: low'";
  if (key == "bit") return "add 'bit: 0', or another one up to 15";
  return fmt::format("add '{}: BYTES'", key);
}

/// Returns what to do about a key that the type does not have.
std::string remedy_for_other_type(const Entry& given, Type type) {
  if (given.key == "offset" && parse_number(given.text) && codec::is_scalable(type))
    return fmt::format(
        "what is added to a value belongs to its scale, as in 'scale: {{gain: 1, offset: {}}}'", given.text);
  if (given.key == "bits") return "write 'type: UINT', or USINT, WORD or BYTE";
  if (given.key == "bit") return "write 'type: BOOL' for one bit of the register, or remove it";
  if (given.key == "length")
    return fmt::format("remove it: {} says how many registers there are; 'type: STRING' is for texts",
                       to_string(type));
  return "remove it";
}

/// The keys that only some types have.
void check_type_keys(const Reader& reader, const Entry& point, Type type, const Context& context) {
  for (const Key& key : all_keys()) {
    if (key.types.empty() || !reader.knows(key.name)) continue;
    const bool given = reader.has(key.name);
    const bool applies = applies_to(key, to_string(type));
    if (given && !applies)
      reader.refuse(key.name, fmt::format("'{}' does not apply to {}", key.name, to_string(type)),
                    remedy_for_other_type(*reader.find(key.name), type));
    const bool needless = !key.needless_with.empty() && reader.has(key.needless_with);
    const bool required_here = !key.required_with.empty() && reader.has(key.required_with) && !needless;
    const bool required = key.required || required_here;
    if (reader.lacks(key.name) && applies && required)
      context.problems.error(
          point.key_at,
          fmt::format("{} is a {} and has no '{}'", shown(point.key), to_string(type), key.name),
          missing(key.name));
  }
}

/// False if the point's order does not go with its type.
bool check_order(const Entry& order, Type type, const Context& context) {
  const bool one_register = codec::width(type) <= 16;
  const bool two_letters = order.text.size() == 2;
  if (is_text(type) && !two_letters) {
    context.problems.error(
        order.at, fmt::format("the order of a STRING is AB or BA, not {}", order.text),
        "write AB if the first character of a register is in its high byte, BA if it is in its low byte");
  } else if (one_register && !two_letters) {
    context.problems.error(
        order.at, fmt::format("{} has one register, 'order: {}' is for more", to_string(type), order.text),
        "write AB (high byte first) or BA");
  } else if (!one_register && two_letters) {
    context.problems.error(order.at,
                           fmt::format("{} has {} registers, 'order: {}' is for one", to_string(type),
                                       codec::width(type) / 16, order.text),
                           "write ABCD, CDAB, BADC or DCBA");
  } else {
    return true;
  }
  return false;
}

/// Refuses the other keys that say where a value is, or that need whole registers.
bool goes_with_bits(const Reader& reader) {
  for (const std::string_view key : {"offset", "counter", "iio", "pwm"})
    if (reader.knows(key) && reader.has(key)) {
      reader.refuse(key, fmt::format("'{}' does not go with 'bits'", key), "remove one of the two");
      return false;
    }
  return true;
}

/// `bits: [8, 11]`.
void read_bits(const Reader& reader, Format& format, const Context& context) {
  const Entry* entry = reader.find("bits");
  if (entry == nullptr || !applies_to(*find_key("bits", Section::holding_register), to_string(format.type)) ||
      !goes_with_bits(reader))
    return;
  std::array<std::optional<std::uint64_t>, 2> ends;
  if (entry->kind == Entry::Kind::list && entry->children.size() == 2)
    for (std::size_t i = 0; i < 2; ++i)
      if (const Entry& end = entry->children[i]; end.kind == Entry::Kind::scalar && !end.quoted)
        ends[i] = parse_unsigned(end.text);
  const auto& [first, last] = ends;
  if (!first || !last || *first > *last || *last > 15)
    return reader.refuse("bits",
                         "'bits' must be the first and the last bit of the number, 0 to 15, in a list",
                         "write it as in 'bits: [8, 11]'; bit 0 is the least significant");
  if (!reader.has("address"))  // the lock has no places for it
    return reader.refuse("bits", "a point with 'bits' needs an 'address'", "write its 'address'");
  const std::uint64_t count = *last - *first + 1;
  if (count == 1)
    return reader.refuse("bits", "this is one bit", fmt::format("write 'type: BOOL, bit: {}'", *first));
  if (count == 16) return reader.refuse("bits", "these are all bits of the register", "remove 'bits'");
  if (count > codec::width(format.type))
    return context.problems.error(
        entry->at, fmt::format("{} bits do not fit into {}", count, to_string(format.type)),
        fmt::format("write 'type: {}'", format.type == Type::BYTE ? "WORD" : "UINT"));
  format.bit = static_cast<std::uint8_t>(*first);
  format.bits = static_cast<std::uint8_t>(count);
}

void read_order(const Reader& reader, Order map_order, Format& format, const Context& context) {
  Order order = map_order;
  const std::size_t errors = context.problems.errors();
  reader.choice("order", order);
  const Entry* own = reader.find("order");
  if (own != nullptr && context.problems.errors() == errors && !check_order(*own, format.type, context))
    order = map_order;
  const bool several = codec::width(format.type) > 16;
  format.order = codec::make_order(several && words_reversed(order), bytes_swapped(order));
}

void read_text_order(const Reader& reader, Format& format, const Context& context) {
  bool ignore_byteorder = false;
  reader.boolean("ignore_byteorder", ignore_byteorder);
  format.order = ignore_byteorder ? Order::ABCD : Order::BADC;
  const std::size_t errors = context.problems.errors();
  Order own = format.order;
  reader.choice("order", own);
  const Entry* order = reader.find("order");
  if (order == nullptr || context.problems.errors() > errors || !check_order(*order, format.type, context))
    return;
  if (reader.has("ignore_byteorder") && own != format.order)
    reader.refuse("ignore_byteorder", "'ignore_byteorder' says another order than 'order'", "remove it");
  format.order = own;
}

using codec::Type;
using codec::Value;

std::string expected(Type type) {
  if (type == Type::BOOL) return "on or off";
  if (type == Type::STRING) return "text";
  if (codec::is_bit_string(type))
    return fmt::format("a number or a list of {} times true or false", codec::width(type));
  return "a number";
}

/// Element i is bit i.
std::optional<Value> bits(const Entry& list, Type type) {
  if (!codec::is_bit_string(type) || list.children.size() != codec::width(type)) return std::nullopt;
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
  ValueWriter(std::string_view key, const Point& point, const Context& context)
      : key_(key), point_(point), context_(context) {}

  bool write(const Entry& entry, std::uint16_t* registers) const {
    return point_.scale.present() ? write_scaled(entry, registers) : write_plain(entry, registers);
  }

 private:
  /// A name of `values`.
  std::optional<Value> named_value(const Entry& entry) const {
    for (const NamedValue& named : point_.values)
      if (entry.kind == Entry::Kind::scalar && entry.text == named.name) return named.value;
    return std::nullopt;
  }

  bool wrong(const Entry& entry, const std::string& wanted) const {
    context_.problems.error(entry.at,
                            fmt::format("'{}' of type {} must be {}, not {}", key_,
                                        to_string(point_.format.type), wanted, shown(entry)),
                            "write " + wanted);
    return false;
  }

  bool write_plain(const Entry& entry, std::uint16_t* registers) const {
    const auto named = named_value(entry);
    const auto value = named ? named : value_of(entry, point_.format.type);
    if (!value) return wrong(entry, expected(point_.format.type));
    if (const auto encoded = codec::encode(*value, point_.format, registers); !encoded) {
      context_.problems.error(entry.at, fmt::format("'{}': {}", key_, encoded.error()),
                              point_.format.bits != 0 ? "write a value that these bits can hold"
                                                      : "write a value that the type can hold");
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
    const auto range = codec::published_range(point_.format, point_.scale);
    context_.problems.error(
        entry.at,
        fmt::format("'{}': {} is published from {:.15g} to {:.15g}, so {} cannot be written", key_,
                    shown(point_.name), range.least, range.most, entry.text),
        "write a value in that range, or change 'scale'");
    return false;
  }

  std::string_view key_;
  const Point& point_;
  const Context& context_;
};

}  // namespace

void read_format(const Reader& reader, const Entry& point, Order order, Format& format,
                 const Context& context) {
  const std::size_t errors = context.problems.errors();
  if (!reader.has("type")) {
    if (!reader.lacks("type")) return;
    context.problems.error(point.key_at, fmt::format("{} has no type", shown(point.key)),
                           reader.has("bits")  ? "add 'type: UINT'"
                           : reader.has("bit") ? "add 'type: BOOL'"
                                               : "add 'type: INT', or what the registers hold");
    return;
  }
  read_type(reader, format.type, context);
  if (context.problems.errors() != errors) return;
  check_type_keys(reader, point, format.type, context);
  if (is_byte(format.type)) reader.choice("offset", format.half);
  if (is_bit(format.type)) reader.integer("bit", format.bit);
  read_bits(reader, format, context);
  if (!is_text(format.type)) return read_order(reader, order, format, context);
  reader.integer("length", format.length);
  reader.choice("encoding", format.encoding);
  read_text_order(reader, format, context);
}

std::vector<std::uint16_t> registers_of(std::string_view key, const Entry& entry, const Point& point,
                                        const Context& context) {
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
  const auto forbidden = find_forbidden(point, registers.data());
  const bool is_no_value_yet = forbidden && forbidden->why == Forbidden::invalid && !is_writable(point);
  if (forbidden && !is_no_value_yet) {
    context.problems.error(entry.at, fmt::format("'{}': {}", key, forbidden_text(point, *forbidden)),
                           "write " + allowed_text(point));
    return {};
  }
  return registers;
}

Span<const std::uint16_t> read_value(std::string_view key, const Entry& entry, const Point& point,
                                     const Context& context) {
  const std::vector<std::uint16_t> registers = registers_of(key, entry, point, context);
  return registers.empty() ? Span<const std::uint16_t>() : context.map.keep(registers);
}

}  // namespace coupler::loader
