// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/configuration.hpp"

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace coupler::host {

std::vector<std::string_view> names_of(const std::vector<MapSource>& sources) {
  std::vector<std::string_view> names;
  names.reserve(sources.size());
  for (const MapSource& source : sources) names.push_back(source.map.name);
  return names;
}

tl::expected<Devices, std::string> configure(
    std::vector<MapSource> sources,
    const std::function<tl::expected<Settings, std::string>(std::string_view name)>& settings_of) {
  Devices devices;
  for (MapSource& source : sources) {
    auto settings = settings_of(source.map.name);
    if (!settings) return tl::make_unexpected(settings.error());
    Configured& device = devices.emplace_back(Configured{std::move(*settings), std::move(source)});
    apply(device.settings, device.source.map);
  }
  return devices;
}

std::string why_not(const Devices& devices) {
  std::set<std::string_view> names;
  for (const auto& [settings, source] : devices) {
    if (source.map.connection.address.empty())
      return fmt::format("the map has no address; add 'address: HOST' or give --address HOST{}",
                         devices.size() > 1 ? fmt::format(" (map of {})", source.map.name) : "");
    if (!names.insert(source.map.name).second)
      return fmt::format(
          "two devices have the name {}; give one of them another, as in --maps left=a.yaml,right=a.yaml",
          source.map.name);
  }
  return {};
}

std::string node_name(std::string_view map_name) {
  std::string name = fmt::format("{}_driver", map_name);
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

std::string node_name_by_address(const Settings& settings) {
  std::string stem = settings.address.value_or("");
  if (stem.empty() && settings.map) stem = settings.map->substr(settings.map->find("//") + 2);
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
