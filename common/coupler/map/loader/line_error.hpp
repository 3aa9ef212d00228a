// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "coupler/map/loader/syntax_error.hpp"

namespace coupler::loader {

/// The text at `offset` follows a quote that was not meant to close one.
SyntaxError text_behind(char quote, std::string_view text, std::size_t offset);

/// Returns what is wrong with the lines of a YAML text that a parser rejects at `offset`, outside brackets.
/// The mistake may be in a line above: without its ':' that line is a text, which goes on below it.
std::optional<SyntaxError> explain_lines(std::string_view text, std::size_t offset);

/// Returns why the line at `offset` is no entry of the map that the lines above began.
std::optional<SyntaxError> explain_stranger(std::string_view text, std::size_t offset);

}  // namespace coupler::loader
