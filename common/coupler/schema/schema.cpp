// SPDX-License-Identifier: Apache-2.0
#include "coupler/schema/schema.hpp"

#include "coupler/base/version.hpp"
#include "coupler/map/loader/names.hpp"
#include "coupler/schema/value_schema.hpp"

namespace coupler::schema {
namespace {

using loader::Key;
using loader::Section;
using loader::ValueKind;

Json object_of(Section section);

/// The tables, and all of them together, may be there and hold nothing.
Json or_nothing(Json object) {
  object["type"] = {"object", "null"};
  return object;
}

/// name -> point. In the tables of bits just the address will do, or nothing: the lock has it.
Json points_of(Section section) {
  Json point = object_of(section);
  if (loader::overlap(section, Section::coil | Section::discrete_input))
    point = {{"anyOf", {value_schema(*loader::find_key("address", section)), or_nothing(std::move(point))}}};
  return or_nothing({{"propertyNames",
                      {{"pattern", ros_name},
                       {"patternErrorMessage", ros_name_rule},
                       {"not", {{"enum", loader::driver_topics}}}}},
                     {"additionalProperties", std::move(point)}});
}

Json values_of(const Key& key) {
  if (key.kind == ValueKind::points) return points_of(key.inside);
  if (key.inside == Section::none) return value_schema(key);
  Json object = object_of(key.inside);
  if (key.inside == Section::mapping) return or_nothing(std::move(object));
  if (key.several) return {{"type", "array"}, {"items", std::move(object)}};
  if (key.kind == ValueKind::section) return object;
  return {{"anyOf", {value_schema(key), std::move(object)}}};
}

Json property(const Key& key) {
  Json schema{{"description", describe(key)}};
  schema.update(values_of(key));
  if (!key.fallback.empty()) schema["default"] = fallback_value(key);
  if (!key.same_as.empty()) schema["doNotSuggest"] = true;  // of yaml-language-server
  return schema;
}

/// Which keys a point's type needs, and which it has no use for.
Json rule_for_types(const Key& key) {
  const Json type{{"properties", {{"type", {{"pattern", any_name(loader::words(key.types))}}}}}};
  Json rule{{"if", type}, {"else", {{"properties", {{key.name, false}}}}}};
  const Json needed = Json::array({key.name});
  if (key.required) rule["then"] = {{"required", needed}};
  if (!key.required_with.empty()) rule["then"] = {{"dependencies", {{key.required_with, needed}}}};
  return rule;
}

Json object_of(Section section) {
  Json properties = Json::object();
  Json required = Json::array();
  Json rules = Json::array();
  Json object{{"type", "object"}, {"additionalProperties", false}};
  for (const Key& key : loader::all_keys()) {
    if (!loader::overlap(key.sections, section)) continue;
    properties[std::string(key.name)] = property(key);
    if (!key.types.empty())
      rules.push_back(rule_for_types(key));
    else if (key.required)
      required.push_back(key.name);
    if (!key.same_as.empty()) object["not"] = {{"required", {key.name, key.same_as}}};
  }
  object["properties"] = std::move(properties);
  if (!required.empty()) object["required"] = std::move(required);
  if (!rules.empty()) {
    object["if"] = {{"required", {"type"}}};
    object["then"] = {{"allOf", std::move(rules)}};
  }
  return object;
}

/// The same for all addresses of a map. "minimum" and "maximum" say nothing of a point that is not a number.
/// Editors suggest these keys from their real place.
Json every_address(Json range) {
  range["doNotSuggest"] = true;
  const Json keys{{"address", range}, {"read_address", range}};
  Json point = range;
  point["properties"] = keys;
  const Json table{{"additionalProperties", std::move(point)}};
  Json places{{"mapping", {{"doNotSuggest", true}, {"additionalProperties", table}}}};
  const Json area{{"properties", {{"from", range}, {"to", range}}}};
  for (const Key& key : loader::all_keys())
    if (key.inside == Section::area)
      places[std::string(key.name)] = {{"doNotSuggest", true}, {"items", area}};
  return {{"properties", std::move(places)}};
}

}  // namespace

std::string map_schema() {
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
              {"$comment", "Made by `coupler schema`, version " + std::string(version)},
              {"description", "One device: where it is, and each of its points."}};
  schema.update(object_of(Section::map));
  schema["if"] = {{"properties", {{"addressing", {{"const", "modicon"}, {"doNotSuggest", true}}}}},
                  {"required", {"addressing"}}};
  schema["then"] = every_address({{"minimum", 1}});
  schema["else"] = every_address({{"maximum", 65535}});
  return schema.dump(2) + '\n';
}

}  // namespace coupler::schema
