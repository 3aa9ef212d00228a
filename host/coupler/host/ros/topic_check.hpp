// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "coupler/host/ros/once_warnings.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// Another node's end of a topic.
struct Endpoint {
  std::string topic;  ///< with its namespace
  std::string node;
  bool publishes = false;  ///< or else it subscribes
  std::string type;        ///< empty: not known; "*": it takes any
};

/// The topics of this node, and the mistakes of other nodes there: they use another type, or a name that
/// leads nowhere, so that no message arrives; or they publish what this node publishes. ROS allows all of it.
class TopicCheck {
 public:
  /// `space`: where the device's topics are, "/cell/press". Maps and points must outlive it.
  void add_device(std::string space, const Map& map) { devices_.push_back({std::move(space) + '/', &map}); }
  /// The topics that ROS has made. Of a topic that is no point's the point is null.
  void add_published(const std::string& topic, std::string_view type, const Point* point = nullptr) {
    published_.emplace(topic, Topic{type, point});
  }
  void add_written(const std::string& topic, std::string_view type, const Point& point) {
    written_.emplace(topic, Topic{type, &point});
  }

  /// Returns the type that others must have at this topic; empty: this node has no such end of it.
  std::string_view needed_type(const std::string& topic, bool publishes) const;
  /// Returns whether it is one of this node's topics, or others may take it for one.
  bool concerns(const std::string& topic) const;

  /// `others`: all ends of the topics that concerns() knows. Findings that are certain come first. All refer
  /// to this object.
  std::vector<Finding> check(const std::vector<Endpoint>& others) const;

 private:
  struct Device {
    std::string space;  ///< with '/' at its end
    const Map* map;
  };
  struct Topic {
    std::string_view type;
    const Point* point;
  };
  using Topics = std::unordered_map<std::string, Topic>;
  using Names = std::unordered_set<std::string_view>;

  static const Point* point_of(const Topics& topics, const std::string& topic);
  const Device* device_of(const std::string& topic) const;
  static void check_type(const Endpoint& other, std::string_view needed, std::vector<Finding>& findings);
  std::string foreign(const Endpoint& other) const;
  bool check_direction(const Endpoint& other, bool is_alone, std::vector<Finding>& findings) const;
  std::string misspelt(const Endpoint& other) const;
  std::string without_topics(const Endpoint& other, const Device& device, const std::string& rest) const;
  std::string without_point(const Endpoint& other, const Device& device) const;
  std::string write_meant_by(const Device& device, const std::string& rest) const;
  std::string value_meant_by(const Device& device, const std::string& rest) const;
  std::string beside_device(const std::string& topic) const;

  std::vector<Device> devices_;
  Topics published_;
  Topics written_;
};

}  // namespace coupler::host
