// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/schema/schema.hpp"

#include <cstdint>
#include <utility>

#include "coupler/base/version.hpp"
#include "coupler/codec/format.hpp"
#include "coupler/map/loader/names.hpp"
#include "coupler/map/table.hpp"
#include "coupler/tools/schema/point_rules.hpp"
#include "coupler/tools/schema/value_schema.hpp"

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

/// name -> role, or name -> tool or axis, which say more than nothing.
Json named_of(Section section) {
  Json each = object_of(section);
  if (section == Section::role) each = or_nothing(std::move(each));
  Json all{{"type", "object"}, {"minProperties", 1}, {"additionalProperties", std::move(each)}};
  if (loader::overlap(section, Section::tool | Section::axis))
    all["propertyNames"] = {
        {"pattern", part_of_a_ros_name},
        {"patternErrorMessage", "a name begins with a letter and has letters, digits and '_'"},
        {"not", {{"const", loader::wait_for_action}}}};
  return all;
}

Json values_of(const Key& key) {
  if (key.kind == ValueKind::points) return points_of(key.inside);
  if (key.kind == ValueKind::named) return named_of(key.inside);
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

/// Returns the rule about the types that need the key, and those that have no use for it.
Json rule_for_types(const Key& key) {
  Json rule{{"if", type_is(loader::words(key.types))}, {"else", {{"properties", {{key.name, false}}}}}};
  const Json needed = Json::array({key.name});
  if (key.required) rule["then"] = {{"required", needed}};
  if (!key.required_with.empty()) rule["then"] = {{"dependencies", {{key.required_with, needed}}}};
  if (!key.needless_with.empty())
    rule["then"] = {{"anyOf", {{{"required", Json::array({key.needless_with})}}, rule["then"]}}};
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
  if (Json::array_t own = point_rules(section); !own.empty()) object["allOf"] = std::move(own);
  return object;
}

/// The same for all addresses of a table. "minimum" and the like say nothing of a point that is not a number.
Json every_address_of(Table table, Json range) {
  Json point = range;
  point["properties"] = {{"address", range}, {"read_address", range}};
  Json places{
      {"mapping", {{"properties", {{to_string(table), {{"additionalProperties", std::move(point)}}}}}}}};
  const Json here{{"properties", {{"table", {{"const", to_string(table)}}}}}};
  const Json area{{"if", here}, {"then", {{"properties", {{"from", range}, {"to", range}}}}}};
  for (const Key& key : loader::all_keys())
    if (key.inside == Section::area) places[std::string(key.name)] = {{"items", area}};
  return {{"properties", std::move(places)}};
}

/// Up to four digits are a number of the table, five and six begin with the table's digit. In front of a
/// number of coils that is a 0, which JSON does not show.
Json modicon_range(Table table) {
  const std::int64_t digit = std::string_view("0134")[index(table)] - '0';
  if (digit == 0) return {{"minimum", 1}, {"maximum", 65536}};
  Json ranges = Json::array({{{"not", {{"type", "number"}}}}});
  for (const auto& [before, most] :
       {std::pair<std::int64_t, std::int64_t>{0, 9999}, {10000, 9999}, {100000, 65536}})
    ranges.push_back({{"minimum", digit * before + 1}, {"maximum", digit * before + most}});
  return {{"anyOf", std::move(ranges)}};
}

/// A value of several registers has its first one before the last.
Json room_for_types() {
  Json rules = Json::array();
  for (const unsigned size : {2U, 4U}) {
    std::vector<std::string_view> types;
    for (const auto& each : enumeration_of<codec::Type>.words)
      if (codec::width(each.value) == 16 * size) types.push_back(each.word);
    const Json most{{"maximum", 65536 - size}};
    rules.push_back(
        {{"if", type_is(types)}, {"then", {{"properties", {{"address", most}, {"read_address", most}}}}}});
  }
  Json tables = Json::object();
  for (const Table table : {Table::input_registers, Table::holding_registers})
    tables[std::string(to_string(table))] = {{"additionalProperties", {{"allOf", rules}}}};
  return {{"properties", {{"mapping", {{"properties", std::move(tables)}}}}}};
}

/// Unless `defaults` says when values are published, a point must, for these keys.
Json publishing() {
  const Json needed{{"dependencies", {{"deadband", {"publish"}}, {"max_interval", {"publish"}}}}};
  Json places = Json::object();
  for (const Table table : tables) places[std::string(to_string(table))] = {{"additionalProperties", needed}};
  const Json given{{"required", {"defaults"}}, {"properties", {{"defaults", {{"required", {"publish"}}}}}}};
  const Json mapping{{"properties", std::move(places)}};
  return {{"if", {{"not", given}}}, {"then", {{"properties", {{"mapping", mapping}}}}}};
}

}  // namespace

std::string map_schema() {
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
              {"$comment", "Made by `coupler schema`, version " + std::string(version)},
              {"description", "One device: where it is, and each of its points."}};
  schema.update(object_of(Section::map));
  schema["if"] = {{"properties", {{"addressing", {{"const", "modicon"}, {"doNotSuggest", true}}}}},
                  {"required", {"addressing"}}};
  Json modicon = Json::array();
  Json zero_based = Json::array({unsuggested(room_for_types())});
  for (const Table table : tables) {
    modicon.push_back(unsuggested(every_address_of(table, modicon_range(table))));
    zero_based.push_back(unsuggested(every_address_of(table, {{"maximum", 65535}})));
  }
  schema["then"] = {{"allOf", std::move(modicon)}};
  schema["else"] = {{"allOf", std::move(zero_based)}};
  schema["allOf"] = Json::array({unsuggested(publishing())});
  schema["definitions"] = definitions();
  return schema.dump(2) + '\n';
}

}  // namespace coupler::schema
