// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/drive.hpp"

#include <future>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "coupler/host/modbus/make_transports.hpp"
#include "coupler/host/ros/device_topics.hpp"
#include "coupler/host/ros/ending.hpp"
#include "coupler/host/ros/program.hpp"

namespace coupler::host {
namespace {

constexpr auto report_interval = std::chrono::milliseconds(100);
constexpr auto diagnostics_interval = std::chrono::seconds(1);

using Topics = std::vector<std::unique_ptr<DeviceTopics>>;

Topics offer(const Devices& devices, Node& node) {
  std::vector<Map> maps;
  for (const auto& [settings, source] : devices) maps.push_back(source.map);
  auto transports = make_transports(maps);
  auto transport = transports.begin();
  Topics topics;
  for (const auto& [settings, source] : devices) {
    if (Ending::asked) break;
    topics.push_back(std::make_unique<DeviceTopics>(node, source.map, std::move(*transport++),
                                                    settings.verify.value_or(Verify::require),
                                                    source.map.poll));
  }
  return topics;
}

/// All at once: each may take most of a second for its safe values. Whether all have them that should.
bool end_all(const Topics& devices) {
  std::vector<std::future<bool>> ends;
  ends.reserve(devices.size());
  for (const auto& device : devices)
    ends.push_back(std::async(std::launch::async, [&device] { return device->end(); }));
  bool safe = true;
  for (auto& end : ends) safe &= end.get();
  return safe;
}

}  // namespace

int drive(const Devices& devices, Node& node) {
  const Topics topics = offer(devices, node);
  Ending::driving = true;
  if (!Ending::asked) node.begin();
  for (Time diagnosed = Time::min(); node.is_running() && !Ending::asked;
       std::this_thread::sleep_for(report_interval)) {
    const Time now = std::chrono::steady_clock::now();
    const bool due = diagnosed == Time::min() || now - diagnosed >= diagnostics_interval;
    bool news = due;
    for (const auto& device : topics) news |= device->report(now, due);
    if (!news) continue;
    diagnosed = now;
    node.publish_diagnostics();
  }
  const bool safe = end_all(topics);  // first: a ROS that hangs may hold up what follows
  node.shut_down();
  return safe ? 0 : not_safe;
}

}  // namespace coupler::host
