// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "coupler/host/core/value_table.hpp"
#include "coupler/host/core/wall_time.hpp"
#include "coupler/host/ros/node.hpp"

namespace coupler::host {

/// A device has the service `schedule` and the topic `scheduled`: a point can be written.
bool can_schedule(const Map& map);

/// The services of a device: `<name>/write`, `<name>/read`, `<name>/<point>/set` for each writable bit,
/// `<name>/reset_watchdog` if the driver uses the coupler's own watchdog, `<name>/schedule`,
/// `<name>/cancel_scheduled` and
/// `<name>/list_scheduled` if a point can be written, and `<name>/safe`. They answer when the result is
/// known, in a thread of their own. `safe`, `schedule` and `read`, which may wait for long, have a thread
/// each: none of them waits for the others, nor they for it.
class DeviceServices {
 public:
  /// The storage of `map`, the table and the counts must outlive it.
  DeviceServices(const Map& map, ValueTable& values, SubscriberCounts& subscribers)
      : map_(map), values_(values), subscribers_(subscribers) {}
  /// Waits for the call in progress. The write that this one waits for must have its result by then.
  ~DeviceServices();
  DeviceServices(const DeviceServices&) = delete;
  DeviceServices& operator=(const DeviceServices&) = delete;

  /// The functions that the services call. None of them waits for anything.
  struct Device {
    WriteHandler writes;
    std::function<std::future<CallAnswer>()> reset;      ///< of the coupler's own watchdog
    std::function<std::future<CallAnswer>()> make_safe;  ///< all outputs
    std::function<std::future<ScheduleAnswer>(const ScheduledWrite&)> schedule;
    std::function<std::future<CallAnswer>(std::uint32_t number)> cancel;  ///< a scheduled write
    std::function<std::vector<WaitingWrite>()> scheduled;
    std::function<DeviceSnapshot()> statistics;
  };

  /// Offers the services but for `set`.
  void start(Node& node, Device device);
  /// Offers `set`, if the point, which is writable, is a bit.
  void offer_set(std::uint32_t index);
  /// The device is not called any more.
  void stop();

 private:
  WriteTicket::Outcome write(Write write);
  WriteTicket::Outcome refuse(const std::string& name, const std::string& why);
  WriteTicket::Outcome answer_write(const std::string& name, const std::string& text);
  ScheduleAnswer answer_schedule(const ServiceThread::ScheduleRequest& request);
  std::vector<ServiceThread::ListedWrite> answer_list();
  ServiceThread::ReadAnswer answer_read(const std::string& name);
  CallAnswer answer_set(std::uint32_t index, bool on);
  /// Makes the call and waits for its answer, which says so where the driver ends.
  template <class Answer, class... Parameters, class... Arguments>
  Answer ask(std::function<std::future<Answer>(Parameters...)> Device::*call, const Arguments&... arguments);
  std::uint32_t index_of(const Point& point) const {
    return static_cast<std::uint32_t>(&point - map_.points.data());
  }
  std::string why_no_value(const Point& point);

  Map map_;
  ValueTable& values_;
  SubscriberCounts& subscribers_;
  std::mutex mutex_;
  std::optional<Device> device_;          ///< none after stop()
  WallTime wall_;                         ///< for the thread of timed_calls_
  std::unique_ptr<ServiceThread> calls_;  // last: they use the others
  std::unique_ptr<ServiceThread> urgent_calls_;
  std::unique_ptr<ServiceThread> read_calls_;
  std::unique_ptr<ServiceThread> timed_calls_;
};

}  // namespace coupler::host
