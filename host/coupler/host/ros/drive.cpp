// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/drive.hpp"

#include <future>
#include <memory>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "coupler/host/modbus/make_transports.hpp"
#include "coupler/host/ros/device_driver.hpp"
#include "coupler/host/ros/program.hpp"

namespace coupler::host {
namespace {

constexpr auto report_interval = std::chrono::milliseconds(100);

using Drivers = std::vector<std::unique_ptr<DeviceDriver>>;

Drivers start_all(const Devices& devices, Node& node) {
  std::vector<Map> maps;
  for (const auto& [settings, source] : devices) maps.push_back(source.map);
  auto transports = make_transports(maps);
  auto transport = transports.begin();
  Drivers drivers;
  std::set<unsigned> panels;  // their ports: of devices with the same setting each has the next one
  for (const auto& [settings, source] : devices) {
    if (Shutdown::requested) break;
    DeviceDriver::Followed followed{settings.record, settings.panel};
    if (followed.recording)
      followed.recording = recording_path(*followed.recording, source.map.name, devices.size() == 1);
    while (followed.panel && !panels.insert(*followed.panel).second) ++*followed.panel;
    drivers.push_back(std::make_unique<DeviceDriver>(node, source.map, followed, std::move(*transport++)));
  }
  return drivers;
}

/// At the same time: each may take most of a second for its safe values. False if one has not all of them.
bool stop_all(const Drivers& drivers) {
  std::vector<std::future<bool>> stops;
  stops.reserve(drivers.size());
  for (const auto& driver : drivers)
    stops.push_back(std::async(std::launch::async, [&driver] { return driver->stop(); }));
  bool safe = true;
  for (auto& stop : stops) safe &= stop.get();
  return safe;
}

}  // namespace

int drive(const Devices& devices, Node& node) {
  const Drivers drivers = start_all(devices, node);
  Shutdown::driving = true;
  if (!Shutdown::requested) node.start();
  for (Time diagnosed = Time::min(); node.is_running() && !Shutdown::requested;
       std::this_thread::sleep_for(report_interval)) {
    const Time now = std::chrono::steady_clock::now();
    const bool due = diagnosed == Time::min() || now - diagnosed >= diagnostics_interval;
    bool publish = due;
    for (const auto& driver : drivers) publish |= driver->report(now, due);
    if (!publish) continue;
    diagnosed = now;
    node.publish_diagnostics();
  }
  const bool safe = stop_all(drivers);  // first: a ROS or a disk that hangs may hold up what follows
  for (const auto& driver : drivers) driver->end_followers();
  node.shut_down();
  return safe ? 0 : not_safe;
}

}  // namespace coupler::host
