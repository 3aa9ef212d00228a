// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/node_name.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace coupler::host {

std::string node_name(std::string_view map_name) {
  std::string name = fmt::format("{}_driver", map_name);
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

std::string node_name_by_address(const Settings& settings) {
  std::string stem = settings.address.value_or(settings.serial.value_or(""));
  if (stem.empty() && settings.map) stem = settings.map->substr(settings.map->find(':') + 1);
  stem.erase(std::min(stem.find('?'), stem.size()));  // the settings of a serial port
  if (settings.port) stem += fmt::format("_{}", *settings.port);
  if (settings.unit) stem += fmt::format("_unit{}", *settings.unit);
  const auto is_sign = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
  std::replace_if(
      stem.begin(), stem.end(), [&](char c) { return !is_sign(c); }, '_');
  stem.erase(0, std::min(stem.find_first_not_of('_'), stem.size()));
  stem.erase(stem.find_last_not_of('_') + 1);
  if (stem.empty()) stem = "coupler";
  return node_name(std::isdigit(static_cast<unsigned char>(stem[0])) != 0 ? "coupler_" + stem : stem);
}

}  // namespace coupler::host
