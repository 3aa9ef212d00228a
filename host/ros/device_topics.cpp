// SPDX-License-Identifier: Apache-2.0
#include "host/ros/device_topics.hpp"

#include <std_msgs/Bool.h>

#include <algorithm>

#include <fmt/format.h>

#include "common/map/loader/load.hpp"
#include "host/ros/ros_log.hpp"

namespace coupler::driver {
namespace {

std::string topic(const Map& map, std::string_view point) { return fmt::format("{}/{}", map.name, point); }

std::vector<std::unique_ptr<PointPublisher>> advertise_all(ros::NodeHandle& handle, const Map& map) {
  std::vector<std::unique_ptr<PointPublisher>> result;
  for (const Point& point : map.points)
    result.push_back(is_readable(point) ? advertise(handle, topic(map, point.name), point) : nullptr);
  return result;
}

ros::Publisher advertise_online(ros::NodeHandle& handle, const Map& map) {
  auto publisher = handle.advertise<std_msgs::Bool>(topic(map, "online"), 1, true);
  publisher.publish(std_msgs::Bool());
  return publisher;
}

}  // namespace

DeviceTopics::DeviceTopics(ros::NodeHandle& handle, const Map& map, Verify verify)
    : map_(map),
      publishers_(advertise_all(handle, map)),
      online_(advertise_online(handle, map)),
      transport_(map.connection),
      thread_(map, verify, load_map, transport_, *this),
      writes_{[this](const Write& write) { thread_.write(write); },
              [this](std::uint32_t point, const std::string& what) { refuse(point, what); }} {
  for (std::uint32_t i = 0; i < map_.points.size(); ++i)
    if (is_writable(map_.points[i]))
      subscribers_.push_back(
          subscribe(handle, topic(map_, map_.points[i].name) + "/write", map_, i, writes_));
}

void DeviceTopics::on_bits(const ReadSpan& span, Span<const std::uint8_t> bits, Time at) {
  std::copy(bits.begin(), bits.end(), bits_.begin());
  on_registers(span, {bits_.data(), bits.size()}, at);
}

void DeviceTopics::on_registers(const ReadSpan& span, Span<const std::uint16_t> registers, Time at) {
  for (const std::uint32_t index : span.points) {
    const std::size_t begin = read_range(map_.points[index]).start() - std::size_t{span.range.start()};
    publishers_[index]->publish(&registers[begin], at);
  }
}

void DeviceTopics::on_online(bool online) {
  if (online)  // what was published before is history
    for (const auto& publisher : publishers_)
      if (publisher) publisher->renew();
  std_msgs::Bool message;
  message.data = online;
  online_.publish(message);
}

void DeviceTopics::on_report(Level level, const std::string& text) {
  log(level, fmt::format("{}: {}", map_.name, text));
}

void DeviceTopics::refuse(std::uint32_t point, const std::string& what) {
  Write refused;
  refused.point = point;
  thread_.refuse(refused, what);
  on_report(Level::warning, "dropped a write to " + what);
}

}  // namespace coupler::driver
