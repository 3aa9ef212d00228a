// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros1/node.hpp"

#include <coupler_driver/Status.h>

#include "coupler/host/ros/status.hpp"
#include "coupler/host/ros/typed_publisher.hpp"
#include "coupler/host/ros1/in_place_queue.hpp"
#include "coupler/host/ros1/logger_service.hpp"
#include "coupler/host/ros1/messages.hpp"
#include "coupler/host/ros1/ros_log.hpp"
#include "coupler/host/ros1/service_thread.hpp"

namespace coupler::host {
namespace {

using diagnostic_msgs::DiagnosticStatus;

std::int8_t diagnostic_level(Level level) {
  switch (level) {
    case Level::info: return DiagnosticStatus::OK;
    case Level::warning: return DiagnosticStatus::WARN;
    case Level::error: break;
  }
  return DiagnosticStatus::ERROR;
}

}  // namespace

Ros1Node::Ros1Node() : loggers_(advertise_loggers()) {
  diagnostics_.setHardwareID("coupler_driver");  // each device has its own
}

std::unique_ptr<PointPublisher> Ros1Node::advertise(const std::string& topic, const Point& point,
                                                    std::uint32_t index, Listeners& listeners) {
  return with_message<Ros1Messages>(point, [&](auto kind) -> std::unique_ptr<PointPublisher> {
    using Kind = decltype(kind);
    auto publisher = std::make_unique<TypedPublisher<Kind, ros::Publisher>>(point, index, listeners);
    auto options = ros::AdvertiseOptions::create<typename Kind::Message>(
        topic, point.host.queue_size, [p = publisher.get()](const auto&) { p->came(); },
        [p = publisher.get()](const auto&) { p->left(); }, ros::VoidPtr(), InPlaceQueue::instance());
    options.latch = point.host.latch;
    publisher->use(handle_.advertise(options));
    return publisher;
  });
}

std::shared_ptr<void> Ros1Node::subscribe(const std::string& topic, const Map& map, std::uint32_t index,
                                          const WriteHandler& handler) {
  return with_message<Ros1Messages>(map.points[index], [&](auto kind) {
    using Kind = decltype(kind);
    using Message = typename Kind::Message;
    auto options = ros::SubscribeOptions::create<Message>(
        topic, writes_per_value * map.points[index].host.queue_size,
        [topic, &map, index, &handler](const boost::shared_ptr<const Message>& message) {
          receive<Kind>(*message, topic, map, index, handler);
        },
        ros::VoidPtr(), InPlaceQueue::instance());
    options.allow_concurrent_callbacks = true;  // never told to try again, which an in-place queue could not
    options.transport_hints = ros::TransportHints().tcpNoDelay();
    return std::shared_ptr<void>(std::make_shared<ros::Subscriber>(handle_.subscribe(options)));
  });
}

std::function<void(bool)> Ros1Node::advertise_online(const std::string& topic) {
  return [publisher = handle_.advertise<std_msgs::Bool>(topic, 1, true)](bool online) {
    std_msgs::Bool message;
    message.data = online;
    publisher.publish(message);
  };
}

Node::PublishStatus Ros1Node::advertise_status(const std::string& topic, const Map& map) {
  const auto status = std::make_shared<Status<coupler_driver::Status>>(map);
  return [status, publisher = handle_.advertise<coupler_driver::Status>(topic, 1, true)](
             const DeviceSnapshot& device, const std::vector<PointQuality>& points, Time now) {
    if (!status->update(device, points, now)) return false;
    status->message().header.stamp = ros::Time::now();
    publisher.publish(status->message());
    return true;
  };
}

std::unique_ptr<ServiceThread> Ros1Node::make_service_thread() {
  return std::make_unique<Ros1ServiceThread>(handle_);
}

void Ros1Node::add_diagnosis(const std::string& name, std::function<Diagnosis()> tell) {
  diagnostics_.add(name, [tell = std::move(tell)](diagnostic_updater::DiagnosticStatusWrapper& status) {
    const Diagnosis diagnosis = tell();
    status.summary(static_cast<unsigned char>(diagnostic_level(diagnosis.level)), diagnosis.text);
    status.hardware_id = diagnosis.hardware_id;
    for (const auto& [key, value] : diagnosis.figures) status.add(key, value);
  });
}

void Ros1Node::shut_down() {
  master_.reset();  // what it tells the master must not come after the end
  ros::shutdown();
}

void Ros1Node::log(Level level, const std::string& text) { ros_log(level, text); }
bool Ros1Node::shows_debug() const { return is_debug_logged(); }
void Ros1Node::log_debug(const std::string& text) { ros_log_debug(text); }

}  // namespace coupler::host
