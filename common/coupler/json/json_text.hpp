// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace coupler {

/// On one line, without a line end. Texts of maps and devices need not be UTF-8: what is not is U+FFFD.
std::string json_text(const nlohmann::ordered_json& json);

}  // namespace coupler
