// SPDX-License-Identifier: Apache-2.0
// Regular expressions (ECMA 262, as JSON Schema has them).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace coupler::schema {

/// What loader::is_relative_ros_name accepts.
constexpr std::string_view ros_name = "^[A-Za-z][A-Za-z0-9_]*(/[A-Za-z0-9_]+)*$";
constexpr std::string_view ros_name_rule =
    "a name begins with a letter and has letters, digits and '_', with '/' between parts";

/// A number with its unit, as "500ms".
constexpr std::string_view duration = R"(^([0-9]+\.?[0-9]*|\.[0-9]+)(us|ms|s|min)$)";

/// No name, port or range; what else is wrong with an address, the loader says.
constexpr std::string_view ip_address =
    R"(^([0-9]+(\.[0-9]+){3}|[0-9A-Fa-f]*:[0-9A-Fa-f]*:[0-9A-Fa-f:.]*(%[^%]+)?)$)";

/// One of the words in any case; where it has '-', '_' or nothing will do too.
std::string any_case(const std::vector<std::string_view>& words);

}  // namespace coupler::schema
