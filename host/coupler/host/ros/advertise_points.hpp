// SPDX-License-Identifier: Apache-2.0
// The topics of a device's points.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/host/core/wall_time.hpp"
#include "coupler/host/ros/node.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// Returns the name of a topic of a device: "press/lamp".
std::string topic(const Map& map, std::string_view name);

/// Returns which points have topics: see choose_points(), whose warnings are logged.
std::vector<bool> choose_topics(Node& node, const Map& map, const std::vector<std::string>& topics);

/// The device whose topics are made, and which of its points have any.
struct ChosenTopics {
  Node& node;
  const Map& map;
  SubscriberCounts& subscribers;
  const std::vector<bool>& has;
};

/// Advertises the readable points. By point; null for the others.
std::vector<std::unique_ptr<PointPublisher>> advertise_all(const ChosenTopics& of);

/// Advertises `<point>/<ending>` of each stamped point. By point; null for the others, and where a point of
/// the map has that name.
using AdvertiseWithTime = decltype(&Node::advertise_stamped);
std::vector<std::unique_ptr<PointPublisher>> advertise_with_time(const ChosenTopics& of, const WallTime& wall,
                                                                 std::string_view ending,
                                                                 AdvertiseWithTime advertise);

}  // namespace coupler::host
