// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/remapping_check.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coupler/base/starts_with.hpp"
#include "coupler/map/nearest.hpp"

namespace coupler::host {

RemappingCheck::RemappingCheck(std::vector<Remapping> given, std::string space)
    : given_(std::move(given)), space_(std::move(space)) {
  if (space_.empty() || space_.back() != '/') space_ += '/';
}

/// Empty: it is in another namespace, or private.
std::string RemappingCheck::relative(const std::string& name) const {
  if (starts_with(name, "~")) return {};
  if (!starts_with(name, "/")) return name;
  return starts_with(name, space_) ? name.substr(space_.size()) : std::string();
}

/// A point's name without that of its device is one that is near; "online" is not, for many nodes have topics
/// of such names.
std::string RemappingCheck::meant(const std::string& name, const std::vector<std::string>& devices) const {
  for (const std::string& device : devices)
    if (const auto found = names_.find(fmt::format("{}/{}", device, name));
        found != names_.end() && found->second)
      return found->first;
  std::vector<std::string_view> names;
  names.reserve(names_.size());
  for (const auto& [known, is_a_points] : names_) names.push_back(known);
  std::sort(names.begin(), names.end());
  return std::string(nearest(name, names));
}

std::vector<std::string> RemappingCheck::unused(const std::vector<std::string>& devices) const {
  std::vector<std::string> lines;
  for (const auto& [from, to] : given_) {
    const std::string name = relative(from);
    if (name.empty() || names_.count(name) > 0) continue;
    const bool is_below = std::any_of(devices.begin(), devices.end(), [&](const std::string& device) {
      return starts_with(name, device + '/');
    });
    const std::string near = meant(name, devices);
    if (!is_below && near.empty()) continue;
    lines.push_back(
        fmt::format("the remapping {}:={} changes nothing: this driver has no topic or service {}{}", from,
                    to, name, near.empty() ? std::string() : fmt::format("; did you mean {}?", near)));
  }
  return lines;
}

}  // namespace coupler::host
