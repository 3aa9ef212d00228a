// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/keys.hpp"

#include <algorithm>

namespace coupler::loader {

std::string_view describe(Section section) {
  switch (section) {
    case Section::map: return "the map";
    case Section::mapping: return "'mapping'";
    case Section::coil: return "a coil";
    case Section::discrete_input: return "a discrete input";
    case Section::input_register: return "an input register";
    case Section::holding_register: return "a holding register";
    case Section::coil_line: return "a coil's 'line'";
    case Section::input_line: return "a discrete input's 'line'";
    case Section::limits: return "'limits'";
    case Section::wire: return "a wire of 'sim'";
    case Section::watchdog: return "'watchdog'";
    case Section::edge: return "'counter' and 'latched'";
    case Section::scale: return "'scale'";
    case Section::iio: return "'iio'";
    case Section::pwm: return "'pwm'";
    case Section::deadman: return "'deadman'";
    case Section::defaults: return "'defaults'";
    case Section::area: return "an area";
    case Section::serial: return "'serial'";
    case Section::security: return "'security'";
    case Section::role: return "a role";
    case Section::tls: return "'tls'";
    case Section::tool: return "a tool";
    case Section::positions: return "'positions'";
    case Section::axis: return "an axis";
    case Section::none: break;
  }
  return "nothing";
}

const Key* find_key(std::string_view name, Section section) {
  for (const Key& key : all_keys())
    if (key.name == name && overlap(key.sections, section)) return &key;
  return nullptr;
}

Section sections_with(std::string_view name) {
  Section result = Section::none;
  for (const Key& key : all_keys())
    if (key.name == name) result = result | key.sections;
  return result;
}

std::vector<std::string_view> key_names(Section section) {
  std::vector<std::string_view> names;
  for (const Key& key : all_keys())
    if (overlap(key.sections, section) && key.same_as.empty()) names.push_back(key.name);
  return names;
}

std::vector<std::string_view> words(std::string_view joined) {
  std::vector<std::string_view> result;
  while (!joined.empty()) {
    const std::size_t bar = joined.find('|');
    result.push_back(joined.substr(0, bar));
    joined = bar == std::string_view::npos ? std::string_view{} : joined.substr(bar + 1);
  }
  return result;
}

bool applies_to(const Key& key, std::string_view type) {
  const auto types = words(key.types);
  return types.empty() || std::find(types.begin(), types.end(), type) != types.end();
}

}  // namespace coupler::loader
