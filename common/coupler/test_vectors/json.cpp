// SPDX-License-Identifier: Apache-2.0
#include "coupler/test_vectors/json.hpp"

#include <cmath>
#include <type_traits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "coupler/codec/text.hpp"
#include "coupler/codec/value.hpp"
#include "coupler/json/json_text.hpp"
#include "coupler/map/fingerprint.hpp"
#include "coupler/test_vectors/cases.hpp"

namespace coupler::test_vectors {
namespace {

std::string json_string(std::string_view text) { return json_text(nlohmann::ordered_json(text)); }

/// ", "key": value" with a value that is JSON already.
std::string field(std::string_view key, std::string_view value) {
  return fmt::format(", \"{}\": {}", key, value);
}

/// Name, table, address, size and access.
std::string place(const Point& point) {
  std::string text = fmt::format("\"name\": {}, \"table\": \"{}\", \"address\": {}, \"{}\": {}",
                                 json_string(point.name), to_string(point.table), point.address,
                                 holds_bits(point.table) ? "bits" : "registers", range(point).count());
  if (point.count > 1) text += field("count", std::to_string(point.count));
  if (point.read_address) text += field("read_address", std::to_string(*point.read_address));
  return text + field("access", json_string(to_string(point.access)));
}

std::string format(const Point& point) {
  using codec::Type;
  const codec::Format& format = point.format;
  std::string text = field("type", json_string(codec::to_string(format.type)));
  if (holds_bits(point.table)) return text;
  text += field("order", json_string(codec::order_text(format)));
  if (format.type == Type::BOOL) text += field("bit", std::to_string(format.bit));
  if (format.bits != 0)
    text += field("bit", std::to_string(format.bit)) + field("width", std::to_string(format.bits));
  else if (codec::width(format.type) == 8)
    text += field("offset", format.half == codec::Half::high ? "\"high\"" : "\"low\"");
  if (codec::is_partial(format)) text += field("mask", fmt::format("\"{:04X}\"", codec::mask(format)));
  if (format.type == Type::STRING)
    text += field("length", std::to_string(format.length)) +
            field("encoding", json_string(codec::to_string(format.encoding)));
  if (point.scale.present())
    text += field("scale", fmt::format(R"({{"gain": {}, "offset": {}}})", json(point.scale.gain, Type::LREAL),
                                       json(point.scale.offset, Type::LREAL)));
  if (!point.units.empty()) text += field("units", json_string(point.units));
  return text;
}

/// One element after the other, `write(element)` each.
template <class Elements, class Write>
std::string list(const Elements& elements, Write write) {
  std::string text;
  for (const auto& element : elements) text += (text.empty() ? "" : ", ") + write(element);
  return "[" + text + "]";
}

std::string line(const Point& point, const Case& one) {
  const auto raw = list(one.raw, [&](std::uint16_t word) {
    return fmt::format(holds_bits(point.table) ? "{}" : "\"{:04X}\"", word);
  });
  // A scaled value is a floating-point number, whatever its type.
  const auto write = [&](const codec::Value& value) { return json(value, point.format.type); };
  const std::string value = point.count > 1 ? list(one.values, write) : write(one.values[0]);
  return fmt::format("      {{\"raw\": {}, \"value\": {}{}}}", raw, value,
                     one.only_read ? ", \"only\": \"read\"" : "");
}

std::string object(const Point& point) {
  const Cases made = cases_of(point);
  std::string cases;
  for (const Case& one : made.cases) cases += (cases.empty() ? "" : ",\n") + line(point, one);
  std::string text = fmt::format("    {{{}{},\n     \"cases\": [\n{}]", place(point), format(point), cases);
  if (!made.refused.empty())
    text += ",\n     \"refused\": " +
            list(made.refused, [&](const codec::Value& value) { return json(value, point.format.type); });
  return text + "}";
}

template <class T>
std::string number(T value) {
  if (std::isnan(value)) return "\"nan\"";
  if (std::isinf(value)) return value < 0 ? "\"-inf\"" : "\"inf\"";
  return codec::decimal(value);
}

}  // namespace

std::string json(const Map& map, std::string_view source, std::string_view version) {
  std::string points;
  for (const Point& point : map.points) points += (points.empty() ? "" : ",\n") + object(point);
  return fmt::format(
      "{{\n  \"format\": 1,\n  \"made_by\": {},\n  \"source\": {},\n  \"map\": {},\n  \"fingerprint\": "
      "\"{}\",\n"
      "  \"points\": [{}{}]\n}}\n",
      json_string(fmt::format("coupler {}", version)), json_string(source), json_string(map.name),
      fingerprint_text(map.fingerprint), points.empty() ? "" : "\n", points);
}

std::string json(const codec::Value& value, codec::Type type) {
  return std::visit(
      [&](const auto& v) -> std::string {
        using T = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<T, std::string>)
          return json_string(v);
        else if constexpr (std::is_floating_point_v<T>)
          return number(v);
        else
          return fmt::format(codec::width(type) == 64 ? "\"{}\"" : "{}", v);
      },
      value);
}

}  // namespace coupler::test_vectors
