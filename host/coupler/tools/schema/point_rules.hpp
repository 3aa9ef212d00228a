// SPDX-License-Identifier: Apache-2.0
// What a map may say of one point or tool where that depends on another of its keys, and of the files of TLS:
// the rules of loader/*_reader.cpp that a JSON Schema can say. It cannot compare two numbers, add them, or
// look at another point.
#pragma once

#include <string_view>
#include <vector>

#include "coupler/tools/schema/value_schema.hpp"

namespace coupler::schema {

/// Schemas that all hold for an object of the section; empty for sections that are no points and no part of
/// them.
Json::array_t point_rules(loader::Section section);

/// `definitions` of the schema: each type by any of its names, and its values.
Json definitions();

/// Editors suggest each key from its real place, not from the properties of a rule.
Json unsuggested(Json rule);

/// "if": the object has one of these types.
Json type_is(const std::vector<std::string_view>& types);

}  // namespace coupler::schema
