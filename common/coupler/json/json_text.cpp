// SPDX-License-Identifier: Apache-2.0
#include "coupler/json/json_text.hpp"

#include <nlohmann/json.hpp>

namespace coupler {

std::string json_text(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

nlohmann::json parse_json(const std::string& text) {
  constexpr int deepest = 16;
  bool is_too_deep = false;
  const auto is_kept = [&](int depth, nlohmann::json::parse_event_t, const nlohmann::json&) {
    is_too_deep |= depth > deepest;
    return depth <= deepest;
  };
  auto json = nlohmann::json::parse(text, is_kept, false);
  return is_too_deep ? nlohmann::json(nlohmann::json::value_t::discarded) : json;
}

}  // namespace coupler
