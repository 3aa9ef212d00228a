// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "coupler/map/loader/keys.hpp"

namespace coupler::schema {

using Json = nlohmann::ordered_json;

/// Numbers of Modicon's count have up to six digits: '4' and a number up to 65536.
constexpr int most_modicon_address = 465536;

/// Returns the schema of a value of the key's kind, except for ValueKind::section, points and named.
Json value_schema(const loader::Key& key);

/// Returns the text for people who point at the key: what it means, what is allowed, what holds without it,
/// an example.
std::string describe(const loader::Key& key);

/// Key::fallback as the kind has it. The key must have one.
Json fallback_value(const loader::Key& key);

// Regular expressions (ECMA 262, as JSON Schema has them).

/// The pattern of what loader::is_relative_ros_name accepts.
constexpr std::string_view ros_name = "^[A-Za-z][A-Za-z0-9_]*(/[A-Za-z0-9_]+)*$";
constexpr std::string_view ros_name_rule =
    "a name begins with a letter and has letters, digits and '_', with '/' between parts";

/// The same without '/'.
constexpr std::string_view part_of_a_ros_name = "^[A-Za-z][A-Za-z0-9_]*$";

/// A number with its unit, as "500ms", of at most so many seconds.
std::string duration_up_to(double most);

/// Returns the pattern of durations that are shorter than so many seconds, which is more than 0. In minutes,
/// only 0 is.
std::string duration_below(double least);

/// No name, port or range; what else is wrong with an address, the loader says.
constexpr std::string_view ip_address =
    R"(^([0-9]+(\.[0-9]+){3}|[0-9A-Fa-f]*:[0-9A-Fa-f]*:[0-9A-Fa-f:.]*(%[^%]+)?)$)";

/// One of the words in any case; where it has '-', '_' or nothing will do too.
std::string any_case(const std::vector<std::string_view>& words);

/// Any name of those types, as coupler/codec/type_name.hpp has them: in any case, the number apart or not.
std::string any_name(const std::vector<std::string_view>& types);

}  // namespace coupler::schema
