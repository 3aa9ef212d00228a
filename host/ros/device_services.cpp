// SPDX-License-Identifier: Apache-2.0
#include "host/ros/device_services.hpp"

#include <utility>

#include <fmt/format.h>

#include "common/codec/number.hpp"
#include "common/plan/planner.hpp"
#include "host/core/health.hpp"
#include "host/core/value_text.hpp"
#include "host/ros/ros_log.hpp"

namespace coupler::driver {
namespace {

using Outcome = WriteResult::Outcome;

using Reply = coupler_driver::Write::Response;

static_assert(outcome_number(Outcome::ok) == Reply::OK &&
              outcome_number(Outcome::superseded) == Reply::SUPERSEDED &&
              outcome_number(Outcome::exception) == Reply::EXCEPTION &&
              outcome_number(Outcome::not_taken) == Reply::NOT_TAKEN &&
              outcome_number(Outcome::lost) == Reply::LOST &&
              outcome_number(Outcome::dropped) == Reply::DROPPED &&
              outcome_number(Outcome::kept) == Reply::KEPT &&
              outcome_number(Outcome::refused) == Reply::REFUSED);

std::uint8_t code_of(const std::optional<modbus::Exception>& exception) {
  return exception ? static_cast<std::uint8_t>(*exception) : 0;
}

bool is_bit(const Point& point) { return point.format.type == codec::Type::BOOL && point.count == 1; }

/// A value that is read at all comes within this.
Duration patience(const Map& map, const Point& point) {
  const std::chrono::duration<double> cycles(2 / plan::rate_of(map, point));
  return std::chrono::duration_cast<Duration>(cycles) + 2 * map.connection.timeout;
}

}  // namespace

void DeviceServices::offer(ros::NodeHandle& handle, Driver driver) {
  driver_ = std::move(driver);
  const auto name = [this](std::string_view service) { return fmt::format("{}/{}", map_.name, service); };
  calls_.advertise<coupler_driver::Write>(handle, name("write"), [this](const auto& request, auto& response) {
    answer_write(request, response);
  });
  calls_.advertise<coupler_driver::Read>(
      handle, name("read"), [this](const auto& request, auto& response) { answer_read(request, response); });
  if (map_.coupler_watchdog.present())
    calls_.advertise<std_srvs::Trigger>(handle, name("reset_watchdog"), [this](const auto&, auto& response) {
      answer_call(&Driver::reset, response);
    });
  urgent_calls_.advertise<std_srvs::Trigger>(handle, name("safe"), [this](const auto&, auto& response) {
    answer_call(&Driver::make_safe, response);
  });
  for (std::uint32_t i = 0; i < map_.points.size(); ++i)
    if (is_writable(map_.points[i]) && is_bit(map_.points[i]))
      calls_.advertise<std_srvs::SetBool>(
          handle, name(fmt::format("{}/set", map_.points[i].name)),
          [this, i](const auto& request, auto& response) { answer_set(i, request.data != 0, response); });
  calls_.start();
  urgent_calls_.start();
}

void DeviceServices::withdraw() {
  calls_.end();
  urgent_calls_.end();
  next_value_.end();
  const std::lock_guard lock(mutex_);
  driver_.reset();
}

DeviceServices::~DeviceServices() { withdraw(); }

const Point* DeviceServices::find_point(const std::string& name, std::string& message) const {
  const Point* point = find(map_, name);
  if (point == nullptr) message = fmt::format("there is no point '{}' in the map of {}", name, map_.name);
  return point;
}

WriteTicket::Outcome DeviceServices::write(std::uint32_t index, Span<const std::uint16_t> value) {
  WriteTicket ticket;
  Write write = make_write(map_, index, value);
  write.listener = &ticket;
  write.ordered = true;
  {
    const std::lock_guard lock(mutex_);
    if (!driver_) return {Outcome::dropped, {}, "dropped: the driver ends"};
    driver_->writes.accept(write);
  }
  return ticket.wait();
}

void DeviceServices::refuse(const std::string& name, const Point* point, const std::string& why,
                            Reply& reply) {
  reply.outcome = Reply::REFUSED;
  reply.message = "refused: " + why;
  const std::lock_guard lock(mutex_);
  if (!driver_) return;
  driver_->writes.refuse(point != nullptr ? std::optional(index_of(*point)) : std::nullopt,
                         fmt::format("{} by the service {}/write: {}", name, map_.name, why));
}

void DeviceServices::answer_write(const coupler_driver::Write::Request& request, Reply& reply) {
  std::string why;
  const Point* point = find_point(request.point, why);
  std::vector<std::uint16_t> value;
  if (point != nullptr && !is_writable(*point)) why = fmt::format("{} cannot be written", point->name);
  if (why.empty()) {
    value.resize(range(*point).count());
    if (const auto parsed = parse_value(request.value, *point, value.data()); !parsed) why = parsed.error();
  }
  if (!why.empty()) return refuse(request.point, point, why, reply);
  const auto outcome = write(index_of(*point), value);
  reply.success = outcome.outcome == Outcome::ok;
  reply.outcome = outcome_number(outcome.outcome);
  reply.exception = code_of(outcome.exception);
  reply.message = outcome.text;
}

void DeviceServices::answer_set(std::uint32_t index, bool on, std_srvs::SetBool::Response& response) {
  const Point& point = map_.points[index];
  const std::uint16_t value =
      holds_bits(point.table) ? std::uint16_t{on} : codec::encode_part(on ? 1 : 0, point.format);
  const auto outcome = write(index, {&value, 1});
  response.success = outcome.outcome == Outcome::ok;
  response.message = outcome.text;
}

void DeviceServices::answer_call(std::function<std::future<Calls::Answer>()> Driver::*call,
                                 std_srvs::Trigger::Response& response) {
  std::future<Calls::Answer> asked;
  {
    const std::lock_guard lock(mutex_);
    if (driver_) asked = ((*driver_).*call)();
  }
  const auto answer = asked.valid() ? asked.get() : Calls::Answer{false, "the driver ends"};
  response.success = answer.success;
  response.message = answer.text;
}

void DeviceServices::answer_read(const coupler_driver::Read::Request& request,
                                 coupler_driver::Read::Response& response) {
  const Point* point = find_point(request.point, response.message);
  if (point == nullptr) return;
  if (const auto why = plan::why_not_read(map_, *point)) {
    response.message = fmt::format("{} is never read", point->name);
    return;
  }
  const std::uint32_t index = index_of(*point);
  const auto deadline = std::chrono::steady_clock::now() + patience(map_, *point);
  listeners_.came(index);
  const auto value = next_value_.wait(index, deadline);
  listeners_.left(index);
  response.success = value.has_value();
  if (value)
    response.value = format_value(value->data(), *point);
  else
    response.message = why_no_value(*point);
}

std::string DeviceServices::why_no_value(const Point& point) {
  const std::lock_guard lock(mutex_);
  const DeviceSnapshot device = driver_ ? driver_->statistics() : DeviceSnapshot{};
  if (driver_ && !device.online)
    return fmt::format("no value of {}: the device is {}", point.name, connection_health(device).text);
  return fmt::format("no value of {} came; {}/status says why", point.name, map_.name);
}

}  // namespace coupler::driver
