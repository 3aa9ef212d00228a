// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "coupler/host/ros/node.hpp"
#include "coupler/host/ros/value_waiter.hpp"

namespace coupler::host {

/// The services of a device: `<name>/write`, `<name>/read`, `<name>/<point>/set` for each writable bit,
/// `<name>/reset_watchdog` where the driver makes use of the coupler's own, and `<name>/safe`. They answer
/// when the result is known, and therefore have a thread of their own; `safe` has another, so that it waits
/// for none of them.
class DeviceServices {
 public:
  /// Nothing is offered yet. What `map` views, and the listeners, must outlive it.
  DeviceServices(const Map& map, Listeners& listeners) : map_(map), listeners_(listeners) {}
  /// Waits for the call in progress; the write that it waits for must have got its result by then.
  ~DeviceServices();
  DeviceServices(const DeviceServices&) = delete;
  DeviceServices& operator=(const DeviceServices&) = delete;

  /// What they call. None of it waits for anything.
  struct Driver {
    WriteHandler writes;
    std::function<std::future<Calls::Answer>()> reset;      ///< of the coupler's own watchdog
    std::function<std::future<Calls::Answer>()> make_safe;  ///< all outputs
    std::function<DeviceSnapshot()> statistics;
  };

  void offer(Node& node, Driver driver);
  /// Calls them no more: what they need may end.
  void withdraw();

  /// Who waits for a value that is read. It must be told when the device is online.
  ValueWaiter& value_waiter() { return value_waiter_; }

 private:
  WriteTicket::Outcome write(std::uint32_t index, Span<const std::uint16_t> value);
  WriteTicket::Outcome refuse(const std::string& name, const Point* point, const std::string& why);
  WriteTicket::Outcome answer_write(const std::string& name, const std::string& text);
  ServiceThread::ReadAnswer answer_read(const std::string& name);
  Calls::Answer answer_set(std::uint32_t index, bool on);
  Calls::Answer answer_call(std::function<std::future<Calls::Answer>()> Driver::*call);
  std::uint32_t index_of(const Point& point) const {
    return static_cast<std::uint32_t>(&point - map_.points.data());
  }
  const Point* find_point(const std::string& name, std::string& message) const;
  std::string why_no_value(const Point& point);

  Map map_;
  Listeners& listeners_;
  std::mutex mutex_;
  std::optional<Driver> driver_;  ///< none after withdraw()
  ValueWaiter value_waiter_;
  std::unique_ptr<ServiceThread> calls_;  // last: they use the others
  std::unique_ptr<ServiceThread> urgent_calls_;
};

}  // namespace coupler::host
