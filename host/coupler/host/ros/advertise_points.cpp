// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/advertise_points.hpp"

#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/ros/chosen_points.hpp"
#include "coupler/host/ros/start_progress.hpp"

namespace coupler::host {

std::string topic(const Map& map, std::string_view name) { return fmt::format("{}/{}", map.name, name); }

std::vector<bool> choose_topics(Node& node, const Map& map, const std::vector<std::string>& topics) {
  ChosenPoints chosen = choose_points(map, topics);
  for (const std::string& warning : chosen.warnings)
    node.log(Level::warning, fmt::format("{}: {}", map.name, warning));
  return std::move(chosen.has);
}

/// Many topics take their time, above all where the processor is busy: a signal ends that.
std::vector<std::unique_ptr<PointPublisher>> advertise_all(const ChosenTopics& of) {
  const auto& points = of.map.points;
  std::vector<std::unique_ptr<PointPublisher>> result(points.size());
  for_each_point(of.node, of.map, "have their topics", [&](std::uint32_t i) {
    if (of.has[i] && is_readable(points[i]))
      result[i] = of.node.advertise(topic(of.map, points[i].name), points[i], i, of.subscribers);
  });
  return result;
}

std::vector<std::unique_ptr<PointPublisher>> advertise_with_time(const ChosenTopics& of, const WallTime& wall,
                                                                 std::string_view ending,
                                                                 AdvertiseWithTime advertise) {
  const auto& points = of.map.points;
  std::vector<std::unique_ptr<PointPublisher>> result(points.size());
  for_each_point(of.node, of.map, "have their topics with stamps", [&](std::uint32_t i) {
    if (!of.has[i] || !points[i].host.stamped) return;
    const std::string name = fmt::format("{}/{}", points[i].name, ending);
    if (find(of.map, name) == nullptr)
      result[i] = (of.node.*advertise)(topic(of.map, name), points[i], i, of.subscribers, wall);
  });
  return result;
}

}  // namespace coupler::host
