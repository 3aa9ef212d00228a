// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/point_keys.hpp"

#include <fmt/format.h>

#include "coupler/map/loader/scalar.hpp"

namespace coupler::loader {
namespace {

using codec::Format;
using codec::Order;
using codec::Type;

bool is_text(Type type) { return type == Type::STRING; }
bool is_byte(Type type) { return codec::width(type) == 8; }
bool is_bit(Type type) { return type == Type::BOOL; }

/// What to do when a type needs the key.
std::string missing(std::string_view key) {
  if (key == "offset") return "add 'offset: high' or 'offset: low'";
  if (key == "bit") return "add 'bit: 0', or another one up to 15";
  return fmt::format("add '{}: BYTES'", key);
}

/// The keys that only some types have.
void check_type_keys(const Reader& reader, const Entry& point, Type type, Context& context) {
  for (const Key& key : all_keys()) {
    if (key.types.empty()) continue;
    const bool given = reader.has(key.name);
    const bool applies = applies_to(key, to_string(type));
    if (given && !applies)
      reader.ignored(key.name, fmt::format("'{}' does not apply to {}", key.name, to_string(type)),
                     "remove it");
    const bool required = key.required || (!key.required_with.empty() && reader.has(key.required_with));
    if (!given && applies && required)
      context.problems.error(
          point.key_at,
          fmt::format("{} is a {} and has no '{}'", shown(point.key), to_string(type), key.name),
          missing(key.name));
  }
}

/// False if the point's order does not go with its type.
bool check_order(const Entry& order, Type type, Context& context) {
  const bool one_register = codec::width(type) <= 16;
  const bool two_letters = order.text.size() == 2;
  if (is_text(type)) {
    context.problems.error(order.key_at, "'order' does not apply to STRING",
                           "write 'ignore_byteorder: true' if its first character is in the high byte");
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

void read_order(const Reader& reader, Order map_order, Format& format, Context& context) {
  Order order = map_order;
  const std::size_t errors = context.problems.errors();
  reader.choice("order", order);
  const Entry* own = reader.find("order");
  if (own != nullptr && context.problems.errors() == errors && !check_order(*own, format.type, context))
    order = map_order;
  const bool several = codec::width(format.type) > 16;
  format.order = codec::make_order(several && words_reversed(order), bytes_swapped(order));
}

void read_text_order(const Reader& reader, Format& format, Context& context) {
  if (const Entry* order = reader.find("order")) check_order(*order, format.type, context);
  bool ignore_byteorder = false;
  reader.boolean("ignore_byteorder", ignore_byteorder);
  format.order = ignore_byteorder ? Order::ABCD : Order::BADC;
}

constexpr std::string_view expected = "a number other than 0, or a map of 'gain' and 'offset'";

std::optional<double> bare_number(const Entry& entry) {
  return entry.kind == Entry::Kind::scalar && !entry.quoted ? parse_number(entry.text) : std::nullopt;
}

}  // namespace

void read_format(const Reader& reader, const Entry& point, Order order, Format& format, Context& context) {
  const std::size_t errors = context.problems.errors();
  if (!reader.has("type")) {
    context.problems.error(
        point.key_at, fmt::format("{} has no type", shown(point.key)),
        reader.has("bit") ? "add 'type: BOOL'" : "add 'type: INT', or what the registers hold");
    return;
  }
  reader.choice("type", format.type);
  if (context.problems.errors() != errors) return;
  check_type_keys(reader, point, format.type, context);
  if (is_byte(format.type)) reader.choice("offset", format.half);
  if (is_bit(format.type)) reader.integer("bit", format.bit);
  if (!is_text(format.type)) return read_order(reader, order, format, context);
  reader.integer("length", format.length);
  reader.choice("encoding", format.encoding);
  read_text_order(reader, format, context);
}

void read_scale(const Reader& reader, Point& point, Context& context) {
  const Entry* entry = reader.find("scale");
  if (entry == nullptr) return;
  if (!codec::is_scalable(point.format.type)) {
    context.problems.error(entry->key_at,
                           fmt::format("'scale' does not apply to {}", to_string(point.format.type)),
                           "use a type that is a number: SINT to ULINT, REAL or LREAL");
    return;
  }
  codec::Scale scale;
  if (entry->kind == Entry::Kind::map) {
    const Reader inside(*entry, Section::scale, context);
    inside.fields(scale);
    if (scale.gain == 0) inside.wrong("gain", "a number other than 0");
  } else if (const auto gain = bare_number(*entry)) {
    scale.gain = *gain;
    if (scale.gain == 0) reader.wrong("scale", expected);
  } else {
    reader.wrong("scale", expected);
  }
  if (scale.gain != 0) point.scale = scale;
}

}  // namespace coupler::loader
