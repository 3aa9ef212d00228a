// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/schema/point_rules.hpp"

#include <initializer_list>
#include <string>

#include "coupler/codec/bit_string.hpp"
#include "coupler/codec/number.hpp"
#include "coupler/codec/scale.hpp"
#include "coupler/map/fields.hpp"

namespace coupler::schema {
namespace {

using codec::Type;
using loader::Section;

using Words = std::vector<std::string_view>;
using Rules = Json::array_t;

constexpr Section inputs = Section::discrete_input | Section::input_register;
constexpr Section bits = Section::coil | Section::discrete_input;
constexpr Section registers = Section::input_register | Section::holding_register;
constexpr Section outputs = Section::coil | Section::holding_register;
constexpr Section lines = Section::coil_line | Section::input_line;

bool is_whole(Type type) { return codec::is_scalable(type) && !codec::is_float(type); }
bool is_part(Type type) { return codec::width(type) == 1 || codec::width(type) == 8; }

template <class Rule>
Words types_that(Rule&& rule) {
  Words found;
  for (const auto& each : enumeration_of<Type>.words)
    if (rule(each.value)) found.push_back(each.word);
  return found;
}

Json when(Json condition, Json then) { return {{"if", std::move(condition)}, {"then", std::move(then)}}; }
Json has(std::string_view key) { return {{"required", Json::array({key})}}; }
Json all_of(Rules rules) { return {{"allOf", std::move(rules)}}; }

/// The key is there and is like that.
Json has(std::string_view key, Json value) {
  return {{"required", Json::array({key})}, {"properties", {{key, std::move(value)}}}};
}
Json is(std::string_view word) { return {{"const", word}}; }

/// Those of the keys that the section has are not there.
Json none_of(const Words& keys, Section section) {
  Json properties = Json::object();
  for (const std::string_view key : keys)
    if (loader::find_key(key, section) != nullptr) properties[std::string(key)] = false;
  return {{"properties", std::move(properties)}};
}

/// If it is there, it is like that.
Json only(std::string_view key, Json value) { return {{"properties", {{key, std::move(value)}}}}; }

Json not_true() {
  return {
      {"not", {{"anyOf", {{{"const", true}}, {{"type", "string"}, {"pattern", any_case({"yes", "on"})}}}}}}};
}

/// Returns the rule that neither value of a coil is 1.
Json not_on() {
  return {{"not",
           {{"anyOf", {{{"enum", {true, 1}}}, {{"type", "string"}, {"pattern", any_case({"yes", "on"})}}}}}}};
}

/// "not" with "required" would refuse a point that is no map, too.
Json not_both(std::string_view a, std::string_view b) { return {{"dependencies", {{a, only(b, false)}}}}; }

Words host_keys(About about) {
  Words keys;
  const HostOptions usual;
  for_each_field(usual, [&](const auto& field, const auto&) {
    if (field.about == about) keys.push_back(field.key);
  });
  return keys;
}

Json is_an_array() { return has("count", {{"minimum", 2}}); }

// Values: `initial`, `safe` of registers, `value` of a deadman.

Json bit_value() {
  return {{"anyOf",
           {{{"type", "boolean"}},
            {{"type", "string"}, {"pattern", any_case({"true", "false", "yes", "no", "on", "off"})}}}}};
}

std::string name_of(Type type) { return std::string(to_string(type)); }
Json reference(const std::string& name) { return {{"$ref", "#/definitions/" + name}}; }
Json values_of(Type type) { return reference("value_of_" + name_of(type)); }

/// Returns the schema of a single value without scale and names.
Json value_definition(Type type) {
  if (type == Type::BOOL) return bit_value();
  if (type == Type::STRING) return {{"type", {"string", "number", "boolean"}}};
  if (is_float(type)) return {{"type", "number"}};
  Json number = codec::with_number(type, [](auto zero) -> Json {
    using Limits = std::numeric_limits<decltype(zero)>;
    if constexpr (std::is_floating_point_v<decltype(zero)>)
      return {{"type", "number"}};
    else
      return {{"type", "integer"}, {"minimum", Limits::lowest()}, {"maximum", Limits::max()}};
  });
  if (!codec::is_bit_string(type)) return number;
  const unsigned width = codec::width(type);
  Json list{{"type", "array"}, {"items", bit_value()}, {"minItems", width}, {"maxItems", width}};
  return {{"anyOf", {std::move(number), std::move(list)}}};
}

/// Every key of the point that holds a value has such a one; an array may list them.
Json with_values(const Json& one, bool has_safe_value = true) {
  const auto rule = [&](const Json& value) {
    // The words come first: a text has values, too, and `hold` is not one of them.
    Json properties{{"initial", value}, {"deadman", {{"properties", {{"value", value}}}}}};
    const Json off{{"type", "string"}, {"pattern", any_case({"false", "no", "off"})}};
    if (has_safe_value) properties["safe"] = {{"anyOf", {{{"enum", {"hold", false}}}, off, value}}};
    return Json{{"properties", std::move(properties)}};
  };
  const Json list{{"type", "array"}, {"minItems", 2}, {"items", one}};
  return {{"if", is_an_array()}, {"then", rule({{"anyOf", {one, list}}})}, {"else", rule(one)}};
}

/// A scale that changes the value; without one, `scale: 1` and a gain of 1 are the same.
Json is_scaled() {
  const Json nothing{
      {"type", "object"},
      {"properties",
       {{"gain", {{"const", 1}}}, {"offset", {{"const", 0}}}, {"exponent_of", false}, {"raw", false}}}};
  return has("scale", {{"not", {{"anyOf", {{{"const", 1}}, nothing}}}}});
}

Json values_rule(Type type) {
  Json plain = reference("point_of_" + name_of(type));
  if (!codec::is_scalable(type)) return plain;
  Json rule{{"if", is_scaled()}, {"then", reference("scaled_point")}, {"else", plain}};
  if (!is_whole(type)) return rule;
  rule["else"] = {
      {"if", has("values")}, {"then", reference("named_point_of_" + name_of(type))}, {"else", plain}};
  return rule;
}

/// `min` and `max` of a number without scale.
Json bounds_rule(Type type) {
  const auto [least, most] = codec::published_range({type}, {});
  Json bound{{"type", "number"}, {"minimum", least}, {"maximum", most}};
  if (is_whole(type)) bound = values_of(type);
  return {{"if", {{"not", is_scaled()}}}, {"then", {{"properties", {{"min", bound}, {"max", bound}}}}}};
}

Json order_rule(Type type) {
  Json orders = Json::array();
  for (const auto& each : enumeration_of<codec::Order>.words)
    if ((each.word.size() == 2) == (codec::width(type) <= 16)) orders.push_back(each.word);
  return only("order", {{"enum", std::move(orders)}});
}

/// `bits` in ascending order, no more than the type has. One rule for each first bit: a schema compares no
/// numbers.
Json ends_in(int width) {
  Rules rules;
  for (int first = 0; first < 16; ++first) {
    const Json begins{{"items", {{{"const", first}}}}};
    const Json last{{"minimum", first + 1}, {"maximum", first + width - 1}};
    rules.push_back(when(begins, {{"items", {Json::object(), last}}}));
  }
  return all_of(std::move(rules));
}

/// `ignore_byteorder` and `order` of a STRING say the same.
Json text_order_rule() {
  const Json same{{"if", only("ignore_byteorder", not_true())},
                  {"then", only("order", is("BA"))},
                  {"else", only("order", is("AB"))}};
  return when(has("ignore_byteorder"), same);
}

/// Returns the rule about the keys that a type does not have.
Json others_rule(Type type) {
  Words refused;
  const bool number = codec::is_scalable(type);
  const bool own_registers = number && !is_part(type);
  if (!number) refused = {"scale", "min", "max", "deadband", "fault_below", "fault_above"};
  if (!is_whole(type)) refused.push_back("values");
  if (!own_registers || is_float(type)) refused.push_back("counter");
  if (!own_registers) refused.insert(refused.end(), {"iio", "pwm"});
  if (type != Type::BOOL) refused.push_back("latched");
  if (type == Type::STRING) refused.push_back("invalid");
  Json rule = none_of(refused, registers);
  if (is_part(type) || type == Type::STRING) rule["properties"]["count"] = {{"const", 1}};
  if (codec::width(type) > 16) rule["properties"]["write_function"] = {{"not", is("single")}};
  return rule;
}

void add_rules_of_registers(Section section, Rules& rules) {
  for (const auto& each : enumeration_of<Type>.words)
    rules.push_back(when(type_is({each.word}), reference("rules_of_" + name_of(each.value))));
  const Json not_zero{{"not", {{"const", 0}}}};
  Json scale = not_zero;
  scale["properties"] = {{"gain", not_zero}};
  rules.push_back(only("scale", std::move(scale)));
  rules.push_back(when(is_scaled(), only("values", false)));
  rules.push_back(only("scale", {{"properties", {{"exponent_of", {{"minLength", 1}}}}}}));
  rules.push_back(when(has("scale", {{"type", "object"}, {"required", {"exponent_of"}}}),
                       none_of({"initial", "min", "max", "iio", "pwm"}, section)));
  rules.push_back(not_both("counter", "iio"));
  rules.push_back(when(has("bits"), none_of({"offset", "counter", "iio", "pwm"}, section)));
  rules.push_back(when(has("bits"), only("count", {{"const", 1}})));
  const Json bit_number{{"type", "integer"}, {"minimum", 0}, {"maximum", 15}};
  const Json all_bits{{"const", Json::array({0, 15})}};
  rules.push_back(only("bits", {{"items", bit_number}, {"not", all_bits}}));
  if (section == Section::input_register) return;
  rules.push_back(not_both("counter", "pwm"));
  rules.push_back(not_both("iio", "pwm"));
  rules.push_back(not_both("counter", "latched"));
}

void add_rules_of_bits(Section section, Rules& rules) {
  rules.push_back(reference("point_of_a_bit"));
  if (section == Section::coil) {
    rules.push_back(not_both("latched", "line"));
    rules.push_back(not_both("latched", "pulse"));
    Json pulsed{{"properties", {{"safe", not_on()}, {"initial", not_on()}, {"verify_write", not_true()}}}};
    rules.push_back(when(has("pulse"), std::move(pulsed)));
    rules.push_back(when({{"not", is_an_array()}}, only("safe", {{"not", {{"type", "array"}}}})));
  }
  for (const std::string_view key : {"active_low", "bias", "drive", "debounce"}) {
    if (loader::find_key(key, section) == nullptr) continue;
    rules.push_back({{"dependencies", {{key, {"line"}}}}});
    rules.push_back(when(has(key), only("line", {{"properties", {{key, false}}}})));
  }
  // A number is an offset without its chip.
  rules.push_back(only("line", {{"not", {{"type", "integer"}}}, {"minLength", 1}}));
}

void add_rules_of_the_host(Section section, Rules& rules) {
  for (const std::string_view key : {"max_interval", "deadband"})
    if (loader::find_key(key, section) != nullptr)
      rules.push_back(when(has("publish", {{"not", is("on_change")}}), only(key, false)));
  if (loader::overlap(section, inputs)) {
    rules.push_back(only("access", is("read")));
    return;
  }
  Words reading = host_keys(About::reading);
  reading.push_back("read_address");
  Json unread = none_of(reading, section);
  unread["properties"]["verify_write"] = not_true();
  rules.push_back(when(has("access", is("write")), std::move(unread)));
  Words writing = host_keys(About::writing);
  writing.insert(writing.end(), {"deadman", "latched", "pulse"});
  rules.push_back(when(has("access", is("read")), none_of(writing, section)));
}

void add_rules_of_arrays(Section section, Rules& rules) {
  Json array = none_of({"line", "counter", "latched", "pulse", "iio", "pwm"}, section);
  array["properties"]["stamped"] = not_true();
  if (loader::overlap(section, outputs)) array["properties"]["write_function"] = {{"not", is("single")}};
  rules.push_back(when(is_an_array(), std::move(array)));
}

/// `scale:` as a map.
Rules rules_of_a_scale() {
  Rules rules{{{"dependencies", {{"raw", {"value"}}, {"value", {"raw"}}}}}};
  for (const std::string_view factor : {"gain", "offset", "exponent_of"})
    rules.push_back(not_both("raw", factor));
  return rules;
}

/// `line:` as a map.
Rules rules_of_a_line() {
  return {{{"oneOf", {has("name"), {{"required", {"chip", "offset"}}}}}},
          {{"dependencies", {{"chip", {"offset"}}, {"offset", {"chip"}}}}},
          only("chip", {{"minLength", 1}}),
          only("name", {{"minLength", 1}})};
}

/// One of `sim:`.
Rules rules_of_a_wire() {
  return {{{"oneOf", {has("from"), has("square")}}}, {{"dependencies", {{"invert", {"from"}}}}}};
}

/// The path of a PEM file, and not what is in it.
Json path_of_pem() { return {{"minLength", 1}, {"not", {{"pattern", "-----BEGIN"}}}}; }

/// `security:`: nothing of TLS, or all of it.
Rules rules_of_security() {
  Rules rules;
  for (const std::string_view key : {"certificate", "key", "ca", "revoked"})
    rules.push_back(only(key, path_of_pem()));
  rules.push_back({{"dependencies",
                    {{"certificate", {"key", "ca"}},
                     {"key", {"certificate"}},
                     {"ca", {"certificate"}},
                     {"revoked", {"certificate"}},
                     {"port", {"certificate"}},
                     {"no_role", {"certificate"}}}}});
  return rules;
}

/// `tls:`
Rules rules_of_tls() {
  Rules rules;
  for (const std::string_view key : {"certificate", "key", "ca"}) rules.push_back(only(key, path_of_pem()));
  rules.push_back(only("pin", {{"pattern", "^sha256:(:*[0-9A-Fa-f]){64}:*$"}}));
  rules.push_back({{"oneOf", {has("ca"), has("pin")}}});
  return rules;
}

/// `joint:` of a tool or an axis
Json joint_rule() { return only("joint", {{"pattern", R"(^[^\u0000-\u0020\u007f-\u009f]+$)"}}); }

/// One of `tools:`
Rules rules_of_a_tool() {
  const Json both_sensors{{"required", {"closed", "opened"}}};
  return {{{"anyOf", {has("close"), has("open")}}},
          {{"anyOf", {has("travel"), both_sensors}}},
          {{"dependencies", {{"empty", {"holds"}}}}},
          joint_rule(),
          when(has("hold", not_true()), {{"required", {"close", "open"}}})};
}

}  // namespace

Rules point_rules(Section section) {
  Rules rules;
  if (loader::overlap(section, lines)) {
    rules = rules_of_a_line();
  } else if (section == Section::scale) {
    rules = rules_of_a_scale();
  } else if (section == Section::wire) {
    rules = rules_of_a_wire();
  } else if (section == Section::iio) {
    rules = {only("device", {{"minLength", 1}}), only("channel", {{"minLength", 1}})};
  } else if (section == Section::pwm) {
    rules = {only("chip", {{"minLength", 1}})};
  } else if (section == Section::security) {
    rules = rules_of_security();
  } else if (section == Section::tls) {
    rules = rules_of_tls();
  } else if (section == Section::tool) {
    rules = rules_of_a_tool();
  } else if (section == Section::axis) {
    rules = {joint_rule()};
  } else if (loader::overlap(section, bits)) {
    add_rules_of_bits(section, rules);
  } else if (loader::overlap(section, registers)) {
    add_rules_of_registers(section, rules);
  }
  if (loader::overlap(section, bits | registers)) {
    add_rules_of_arrays(section, rules);
    add_rules_of_the_host(section, rules);
  }
  for (Json& rule : rules) rule = unsuggested(std::move(rule));
  return rules;
}

Json definitions() {
  Json all{{"name_of_a_value", {{"type", "string"}, {"pattern", "^[A-Za-z][A-Za-z0-9_]*$"}}},
           // `safe` of a coil has words of its own.
           {"point_of_a_bit", with_values(bit_value(), false)},
           {"scaled_point", with_values({{"type", "number"}})}};
  for (const auto& each : enumeration_of<Type>.words) {
    all["type_" + name_of(each.value)] = {{"pattern", any_name({each.word})}};
    all["value_of_" + name_of(each.value)] = value_definition(each.value);
    all["point_of_" + name_of(each.value)] = with_values(values_of(each.value));
    if (is_whole(each.value))
      all["named_point_of_" + name_of(each.value)] =
          with_values({{"anyOf", {values_of(each.value), reference("name_of_a_value")}}});
    Rules rules{order_rule(each.value), others_rule(each.value), values_rule(each.value)};
    if (codec::is_scalable(each.value)) rules.push_back(bounds_rule(each.value));
    if (each.value == Type::STRING) rules.push_back(text_order_rule());
    if (loader::applies_to(*loader::find_key("bits", Section::holding_register), each.word))
      rules.push_back(only("bits", ends_in(static_cast<int>(codec::width(each.value)))));
    all["rules_of_" + name_of(each.value)] = all_of(std::move(rules));
  }
  return unsuggested(std::move(all));
}

Json unsuggested(Json rule) {
  if (!rule.is_structured()) return rule;
  for (auto& [key, value] : rule.items()) {
    value = unsuggested(std::move(value));
    if (key != "properties") continue;
    for (Json& property : value) {
      if (!property.is_object()) continue;
      if (property.contains("$ref")) property = all_of({std::move(property)});  // beside it nothing counts
      property["doNotSuggest"] = true;
    }
  }
  return rule;
}

Json type_is(const Words& types) {
  Json names = Json::array();
  for (const std::string_view type : types) names.push_back(reference("type_" + std::string(type)));
  return has("type", types.size() == 1 ? names[0] : Json{{"anyOf", std::move(names)}});
}

}  // namespace coupler::schema
