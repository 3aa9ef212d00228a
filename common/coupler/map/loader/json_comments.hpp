// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "coupler/map/loader/problems.hpp"

namespace coupler::loader {

/// The first character outside blanks and comments is "{": a JSON document, in which comments are allowed.
bool is_json(std::string_view text);

/// Puts blanks in the place of // and /* */ comments outside strings, so that lines and columns stay.
/// False, with the reason in `problems`, if a comment, a string or a bracket has no end.
bool blank_comments(std::string& text, Problems& problems);

}  // namespace coupler::loader
