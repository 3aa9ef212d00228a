// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "coupler/map/loader/syntax_error.hpp"

namespace coupler::loader {

constexpr const char* remedy_for_quotes = "of an apostrophe in single quotes write two, or use double quotes";

/// What is wrong with the lines of a YAML text, of which a parser has noticed at `offset` that they make no
/// sense, outside brackets. The mistake may be in a line above: without its ':' that is a text, which goes
/// on.
std::optional<SyntaxError> explain_lines(std::string_view text, std::size_t offset);

/// Why what begins at `offset` is no entry of the map that the lines above began.
std::optional<SyntaxError> explain_stranger(std::string_view text, std::size_t offset);

}  // namespace coupler::loader
