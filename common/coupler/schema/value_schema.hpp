// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "coupler/map/loader/keys.hpp"

namespace coupler::schema {

using Json = nlohmann::ordered_json;

/// Numbers of Modicon's count have up to six digits: '4' and a number up to 65536.
constexpr int most_modicon_address = 465536;

/// What a value of the key's kind looks like. Not for ValueKind::section and points.
Json value_schema(const loader::Key& key);

/// For people who point at the key: what it means, what is allowed, what holds without it, an example.
std::string describe(const loader::Key& key);

/// Key::fallback as the kind has it. The key must have one.
Json fallback_value(const loader::Key& key);

}  // namespace coupler::schema
