// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/drive.hpp"

#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "coupler/base/what_failed.hpp"
#include "coupler/host/modbus/make_links.hpp"
#include "coupler/host/ros/device_driver.hpp"
#include "coupler/host/ros/program.hpp"
#include "coupler/host/ros/shutdown.hpp"

namespace coupler::host {
namespace {

constexpr auto report_interval = std::chrono::milliseconds(100);

constexpr unsigned longest_end_after_failure = 10;  // s

using Drivers = std::vector<std::unique_ptr<DeviceDriver>>;

/// At the same time, as far as there are threads: each may take most of a second for its safe values. False
/// if one has not all of them.
bool stop_all(const Drivers& drivers, bool (DeviceDriver::*stop)()) {
  std::vector<std::future<bool>> stops;
  stops.reserve(drivers.size());
  for (const auto& driver : drivers)
    stops.push_back(std::async(std::launch::async | std::launch::deferred,
                               [&driver, stop] { return (driver.get()->*stop)(); }));
  bool safe = true;
  for (auto& one : stops) safe &= one.get();
  return safe;
}

/// The start waits for ROS, and a master that hangs may let it wait for ever. If a signal comes once
/// something has been driven, and the start is not over soon, this ends the program with safe outputs.
class StartWatch {
 public:
  explicit StartWatch(Drivers& drivers) : drivers_(drivers), thread_([this] { watch(); }) {}
  StartWatch(const StartWatch&) = delete;
  StartWatch& operator=(const StartWatch&) = delete;
  ~StartWatch() {
    {
      const std::lock_guard lock(mutex_);
      is_over_ = true;
    }
    over_.notify_one();
    thread_.join();
  }

  DeviceDriver& add(std::unique_ptr<DeviceDriver> driver) {
    const std::lock_guard lock(mutex_);
    return *drivers_.emplace_back(std::move(driver));
  }

 private:
  [[noreturn]] void end_at_once() {
    const bool safe = stop_all(drivers_, &DeviceDriver::stop_device);
    ::_exit(!safe ? not_safe : Shutdown::has_failed_thread ? wrong_input : 0);
  }
  void watch() {
    constexpr auto soon = std::chrono::seconds(1);
    std::unique_lock lock(mutex_);
    for (Time ended = Time::max(); !over_.wait_for(lock, report_interval, [this] { return is_over_; });) {
      if (!Shutdown::requested || !Shutdown::is_driving()) continue;
      const Time now = std::chrono::steady_clock::now();
      ended = std::min(ended, now);
      if (now - ended > soon) end_at_once();
    }
  }

  Drivers& drivers_;
  std::mutex mutex_;
  std::condition_variable over_;
  bool is_over_ = false;
  std::thread thread_;  // last: it uses the others
};

void start_all(const Devices& devices, Node& node, Drivers& drivers) {
  StartWatch watch(drivers);
  std::vector<Map> maps;
  for (const auto& [settings, source] : devices) maps.push_back(source.map);
  auto links = make_links(maps);
  auto link = links.begin();
  std::set<unsigned> panels;  // their ports: of devices with the same setting each has the next one
  for (const auto& [settings, source] : devices) {
    if (Shutdown::requested) break;
    DeviceDriver::Followed followed{settings.record, settings.panel};
    if (followed.recording)
      followed.recording = recording_path(*followed.recording, source.map.name, devices.size() == 1);
    while (followed.panel && !panels.insert(*followed.panel).second) ++*followed.panel;
    watch
        .add(std::make_unique<DeviceDriver>(node, source.map, std::move(*link++),
                                            settings.topics.value_or(std::vector<std::string>())))
        .begin(followed);
  }
}

void report_until_the_end(Node& node, const Drivers& drivers) {
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
}

}  // namespace

int drive(const Devices& devices, Node& node) {
  Drivers drivers;
  std::optional<std::string> failure;
  try {
    start_all(devices, node, drivers);
    Shutdown::begin_driving();
    if (!Shutdown::requested) node.start();
    report_until_the_end(node, drivers);
  } catch (const std::exception& error) {  // no thread or no memory is left, or ROS 2 refuses
    failure = what_failed(error);
  } catch (...) {  // XmlRpc's, which has no base
    failure = "ROS gave an answer that cannot be read";
  }
  if (Shutdown::has_failed_thread && !failure) failure.emplace("one of its threads has failed");
  const std::chrono::seconds patience(5 + drivers.size());
  Shutdown::begin_to_end(not_safe, patience);
  if (failure)
    ::alarm(static_cast<unsigned>(patience.count()) + longest_end_after_failure);  // no signal comes
  const bool safe =
      stop_all(drivers, &DeviceDriver::stop);  // first: a ROS or a disk that hangs may hold up what follows
  const int exit_code = !safe ? not_safe : failure ? wrong_input : 0;
  Shutdown::begin_to_end(exit_code, patience_after_outputs);
  if (failure) node.log(Level::error, "the driver has to end: " + *failure);
  for (const auto& driver : drivers) driver->end_followers();
  if (Shutdown::has_failed_thread) ::_exit(exit_code);  // it stands still, and would be waited for
  node.shut_down();
  return exit_code;
}

}  // namespace coupler::host
