// SPDX-License-Identifier: Apache-2.0
#include "coupler/json/json_text.hpp"

#include <nlohmann/json.hpp>

namespace coupler {

std::string json_text(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace coupler
