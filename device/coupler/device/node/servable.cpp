// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/servable.hpp"

#include <fmt/format.h>

#include "coupler/map/identity.hpp"

namespace coupler::device {

tl::expected<AllowList, std::string> allow_list_of(const Map& map) {
  std::vector<Network> networks;
  for (const std::string_view text : map.service.allow) {
    const auto network = parse_network(text);
    if (!network)
      return tl::unexpected(
          fmt::format("'allow': '{}' {}; {}", text, network.error().what, network.error().remedy));
    networks.push_back(*network);
  }
  return AllowList(std::move(networks));
}

tl::expected<void, std::string> check_servable(const Map& map) {
  std::string errors;
  for (const Point& point : map.points) {
    if (holds_bits(point.table) || !range(point).overlaps(identity::reserved)) continue;
    errors += fmt::format(
        "{}point '{}': {} {} is in the area that every node keeps for its identity (0x{:04X} to 0x{:04X}); "
        "move it below",
        errors.empty() ? "" : "\n", point.name, to_string(point.table), point.address,
        identity::reserved.start(), identity::reserved.last());
  }
  if (!errors.empty()) return tl::unexpected(std::move(errors));
  return {};
}

}  // namespace coupler::device
