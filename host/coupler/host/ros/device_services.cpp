// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/device_services.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/core/health.hpp"
#include "coupler/host/core/named_write.hpp"
#include "coupler/host/core/value_text.hpp"
#include "coupler/map/printable.hpp"
#include "coupler/plan/planner.hpp"

namespace coupler::host {
namespace {

using Outcome = WriteResult::Outcome;

/// The value as the service `write` takes it.
std::string value_text(const Write& write, const Point& point) {
  if (!holds_bits(point.table)) return format_value(write.registers.data(), point);
  std::array<std::uint16_t, modbus::max_write_bits> bits{};
  for (std::size_t i = 0; i < point.count; ++i) bits[i] = write.bit(i) ? 1 : 0;
  return format_value(bits.data(), point);
}

/// A point that is read has a new value within this time.
Duration answer_timeout(const Map& map, const Point& point) {
  const std::chrono::duration<double> cycles(2 / plan::rate_of(map, point));
  return std::chrono::duration_cast<Duration>(cycles) + 2 * map.connection.timeout;
}

}  // namespace

bool can_schedule(const Map& map) {
  return std::any_of(map.points.begin(), map.points.end(),
                     [](const Point& point) { return is_writable(point); });
}

void DeviceServices::start(Node& node, Device device) {
  device_ = std::move(device);
  calls_ = node.make_service_thread();
  urgent_calls_ = node.make_service_thread();
  read_calls_ = node.make_service_thread();
  const auto name = [this](std::string_view service) { return fmt::format("{}/{}", map_.name, service); };
  calls_->offer_write(name("write"), [this](const std::string& point, const std::string& value) {
    return answer_write(point, value);
  });
  read_calls_->offer_read(name("read"), [this](const std::string& point) { return answer_read(point); });
  if (map_.coupler_watchdog.present())
    calls_->offer_trigger(name("reset_watchdog"), [this] { return ask(&Device::reset); });
  urgent_calls_->offer_trigger(name("safe"), [this] { return ask(&Device::make_safe); });
  if (can_schedule(map_)) {
    timed_calls_ = node.make_service_thread();
    timed_calls_->offer_schedule(name("schedule"), [this](const ServiceThread::ScheduleRequest& request) {
      return answer_schedule(request);
    });
    timed_calls_->offer_cancel(name("cancel_scheduled"),
                               [this](std::uint32_t number) { return ask(&Device::cancel, number); });
    timed_calls_->offer_list(name("list_scheduled"), [this] { return answer_list(); });
    timed_calls_->start();
  }
  urgent_calls_->start();
  read_calls_->start();
  calls_->start();
}

void DeviceServices::offer_set(std::uint32_t index) {
  if (const Point& point = map_.points[index]; is_single_bit(point))
    calls_->offer_set(fmt::format("{}/{}/set", map_.name, point.name),
                      [this, index](bool on) { return answer_set(index, on); });
}

void DeviceServices::stop() {
  for (ServiceThread* thread : {calls_.get(), urgent_calls_.get(), read_calls_.get(), timed_calls_.get()})
    if (thread != nullptr) thread->stop();
  values_.end_waits();
  const std::lock_guard lock(mutex_);
  device_.reset();
}

DeviceServices::~DeviceServices() { stop(); }

template <class Answer, class... Parameters, class... Arguments>
Answer DeviceServices::ask(std::function<std::future<Answer>(Parameters...)> Device::*call,
                           const Arguments&... arguments) {
  std::future<Answer> asked;
  {
    const std::lock_guard lock(mutex_);
    if (device_) asked = ((*device_).*call)(arguments...);
  }
  return asked.valid() ? asked.get() : Answer{{}, "the driver ends"};
}

WriteTicket::Outcome DeviceServices::write(Write write) {
  WriteTicket ticket;
  write.listener = &ticket;
  write.ordered = true;
  {
    const std::lock_guard lock(mutex_);
    if (!device_) return {Outcome::dropped, {}, "dropped: the driver ends"};
    device_->writes.accept(write);
  }
  return ticket.wait();
}

WriteTicket::Outcome DeviceServices::refuse(const std::string& name, const std::string& why) {
  const Point* point = find(map_, name);
  const std::lock_guard lock(mutex_);
  if (device_)
    device_->writes.refuse(point != nullptr ? std::optional(index_of(*point)) : std::nullopt,
                           fmt::format("{} by the service {}/write: {}",
                                       point != nullptr ? name : excerpt(name), map_.name, why));
  return {Outcome::refused, {}, "refused: " + why};
}

WriteTicket::Outcome DeviceServices::answer_write(const std::string& name, const std::string& text) {
  const auto asked = write_named(map_, name, text);
  return asked ? write(*asked) : refuse(name, asked.error());
}

/// A duration is in whole milliseconds, as long as was asked for at least.
ScheduleAnswer DeviceServices::answer_schedule(const ServiceThread::ScheduleRequest& request) {
  using std::chrono::milliseconds;
  const auto write = write_named(map_, request.point, request.value);
  if (!write) return {0, write.error()};
  const WallTime now = measured_wall_time();
  // Another measurement would map the same time to another instant, and so to another order.
  if (!wall_.agrees_with(now) || now.error() < wall_.error() / 10) wall_ = now;
  ScheduledWrite what{*write, wall_.at(request.at), {}, request.at};
  what.duration = request.how_long.count() < 0 ? std::chrono::floor<milliseconds>(request.how_long)
                                               : std::chrono::ceil<milliseconds>(request.how_long);
  return ask(&Device::schedule, what);
}

std::vector<ServiceThread::ListedWrite> DeviceServices::answer_list() {
  std::vector<WaitingWrite> waiting;
  {
    const std::lock_guard lock(mutex_);
    if (device_) waiting = device_->scheduled();
  }
  std::vector<ServiceThread::ListedWrite> listed;
  listed.reserve(waiting.size());
  for (const auto& [which, by_device] : waiting) {
    const Point& point = map_.points[which.what.write.point];
    listed.push_back({which.number, std::string(point.name), value_text(which.what.write, point),
                      which.what.asked, which.what.duration, by_device});
  }
  return listed;
}

CallAnswer DeviceServices::answer_set(std::uint32_t index, bool on) {
  const auto outcome = write(make_bit_write(map_, index, on));
  return {outcome.outcome == Outcome::ok, outcome.text};
}

ServiceThread::ReadAnswer DeviceServices::answer_read(const std::string& name) {
  ServiceThread::ReadAnswer answer;
  const auto named = read_point_named(map_, name);
  if (!named) {
    answer.message = named.error();
    return answer;
  }
  const Point& point = **named;
  const std::uint32_t index = index_of(point);
  const auto now = std::chrono::steady_clock::now();
  subscribers_.add(index);
  answer.success = values_.wait(index, now, now + answer_timeout(map_, point), ValueTable::Offline::gives_up);
  subscribers_.remove(index);
  const ValueTable::Value value = values_.get(index, now);
  if (!answer.success) {
    answer.message = why_no_value(point);
  } else if (value.has_value()) {
    answer.value = format_value(value.registers.data(), point);
  } else {
    answer.success = false;
    answer.message = fmt::format("no value of {}: {}", point.name, value.why_unusable);
  }
  return answer;
}

std::string DeviceServices::why_no_value(const Point& point) {
  const std::lock_guard lock(mutex_);
  const DeviceSnapshot device = device_ ? device_->statistics() : DeviceSnapshot{};
  if (device_ && !device.online)
    return fmt::format("no value of {}: the device is {}", point.name, connection_health(device).text);
  return fmt::format("no value of {} came in time; {}/status says why", point.name, map_.name);
}

}  // namespace coupler::host
