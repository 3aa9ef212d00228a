// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace coupler {

/// On one line, without a line end. Texts of maps and devices need not be UTF-8: what is not is U+FFFD.
std::string json_text(const nlohmann::ordered_json& json);

/// Discarded if the text is no JSON, or is nested deeper than 16 levels: to copy it would take as much of the
/// stack.
nlohmann::json parse_json(const std::string& text);

}  // namespace coupler
