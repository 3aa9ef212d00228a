// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros1/node.hpp"

#include <coupler_driver/CancelScheduled.h>
#include <coupler_driver/ListScheduled.h>
#include <coupler_driver/Points.h>
#include <coupler_driver/Read.h>
#include <coupler_driver/Schedule.h>
#include <coupler_driver/Scheduled.h>
#include <coupler_driver/Status.h>
#include <coupler_driver/ToolState.h>
#include <coupler_driver/Write.h>
#include <ros/callback_queue.h>
#include <ros/console.h>
#include <ros/names.h>
#include <ros/this_node.h>
#include <sensor_msgs/JointState.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <cstdio>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coupler/host/ros/node_templates.hpp"
#include "coupler/host/ros/point_info.hpp"
#include "coupler/host/ros/topic_depth.hpp"
#include "coupler/host/ros1/in_place_queue.hpp"
#include "coupler/host/ros1/logger_service.hpp"
#include "coupler/host/ros1/messages.hpp"
#include "coupler/host/ros1/topics.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::host {
namespace {

struct Ros1Services {
  using Write = coupler_driver::Write;
  using Read = coupler_driver::Read;
  using Schedule = coupler_driver::Schedule;
  using CancelScheduled = coupler_driver::CancelScheduled;
  using ListScheduled = coupler_driver::ListScheduled;
  using SetBool = std_srvs::SetBool;
  using Trigger = std_srvs::Trigger;
};

class Ros1ServiceThread : public TypedServiceThread<Ros1ServiceThread, Ros1Services> {
 public:
  Ros1ServiceThread(ros::NodeHandle& handle, RemappingCheck& remappings, std::size_t calls)
      : handle_(handle), remappings_(remappings), calls_(calls) {}
  ~Ros1ServiceThread() override {
    queue_.disable();
    for (std::thread& thread : threads_) thread.join();
  }
  Ros1ServiceThread(const Ros1ServiceThread&) = delete;
  Ros1ServiceThread& operator=(const Ros1ServiceThread&) = delete;

  void start() override {
    while (threads_.size() < calls_)
      threads_.emplace_back([this] {
        while (queue_.isEnabled())
          queue_.callOne(ros::WallDuration(3600));  // the wait: a call, or disable(), ends it at once
      });
  }
  void stop() override { queue_.disable(); }

  template <class S, class Function>
  void serve(const std::string& name, Function function) {
    auto options = ros::AdvertiseServiceOptions::create<S>(
        name,
        [function = std::move(function)](typename S::Request& request, typename S::Response& response) {
          function(request, response);
          return true;
        },
        ros::VoidPtr(), &queue_);
    remappings_.add_name(name, false);
    servers_.push_back(handle_.advertiseService(options));
  }

 private:
  ros::NodeHandle& handle_;
  RemappingCheck& remappings_;
  ros::CallbackQueue queue_;
  std::vector<ros::ServiceServer> servers_;
  const std::size_t calls_;           ///< at a time
  std::vector<std::thread> threads_;  // last: they use the others
};

// One function each: a macro of ROS unfolds to a page.
void log_info(const std::string& text) { ROS_INFO("%s", text.c_str()); }
void log_warning(const std::string& text) { ROS_WARN("%s", text.c_str()); }
void log_error(const std::string& text) { ROS_ERROR("%s", text.c_str()); }

void count_subscribers(ros::AdvertiseOptions& options, CountingPublisher& publisher) {
  options.connect_cb = [&publisher](const auto&) { publisher.add_subscriber(); };
  options.disconnect_cb = [&publisher](const auto&) { publisher.remove_subscriber(); };
  options.callback_queue = &InPlaceQueue::instance();
}

template <class Message>
TopicPublisher advertise_latched(ros::NodeHandle& handle, const std::string& topic) {
  ros::AdvertiseOptions options;
  options.init<Message>(topic, 1);
  options.latch = true;
  return {handle, options};
}

/// Those of parameters and of the node itself are not among them.
std::vector<Remapping> given_remappings() {
  std::vector<Remapping> given;
  for (const auto& [from, to] : ros::names::getUnresolvedRemappings()) given.push_back({from, to});
  return given;
}

}  // namespace

Ros1Node::Ros1Node()
    : remappings_(given_remappings(), ros::this_node::getNamespace()),
      loggers_(advertise_loggers(InPlaceQueue::instance())) {
  diagnostics_.setHardwareID("coupler_driver");  // each device has its own
}

template <class Message>
void Ros1Node::note_published(const std::string& topic, const Point* point) {
  topics_.add_published(handle_.resolveName(topic), ros::message_traits::datatype<Message>(), point);
  remappings_.add_name(topic, point != nullptr);
}

template <class Publisher>
std::unique_ptr<PointPublisher> Ros1Node::advertise_as(const std::string& topic, const Point& point,
                                                       std::unique_ptr<Publisher> publisher,
                                                       bool is_stamped) {
  ros::AdvertiseOptions options;
  options.init<typename Publisher::Message>(topic, topic_depth(point));
  options.latch = point.host.latch;
  count_subscribers(options, *publisher);
  publisher->set_publisher(TopicPublisher(handle_, options));
  note_published<typename Publisher::Message>(topic, is_stamped ? nullptr : &point);
  return publisher;
}

std::unique_ptr<PointPublisher> Ros1Node::advertise(const std::string& topic, const Point& point,
                                                    std::uint32_t index, SubscriberCounts& subscribers) {
  return with_message<Ros1Messages>(point, [&](auto kind) {
    using Publisher = TypedPublisher<decltype(kind), TopicPublisher>;
    return advertise_as(topic, point, std::make_unique<Publisher>(point, index, subscribers), false);
  });
}

template <class Messages, class PutStamp>
std::unique_ptr<PointPublisher> Ros1Node::advertise_with_time(const std::string& topic, const Point& point,
                                                              std::uint32_t index,
                                                              SubscriberCounts& subscribers,
                                                              const WallTime& wall) {
  return with_stamped_message<Messages>(point, [&](auto kind) {
    using Publisher = TypedPublisher<decltype(kind), TopicPublisher, PutStamp>;
    return advertise_as(topic, point, std::make_unique<Publisher>(point, index, subscribers, PutStamp(wall)),
                        true);
  });
}

std::unique_ptr<PointPublisher> Ros1Node::advertise_stamped(const std::string& topic, const Point& point,
                                                            std::uint32_t index,
                                                            SubscriberCounts& subscribers,
                                                            const WallTime& wall) {
  return advertise_with_time<Ros1Messages, Stamper>(topic, point, index, subscribers, wall);
}

std::unique_ptr<PointPublisher> Ros1Node::advertise_sample(const std::string& topic, const Point& point,
                                                           std::uint32_t index, SubscriberCounts& subscribers,
                                                           const WallTime& wall) {
  return advertise_with_time<SampleMessages<Ros1Messages>, SampleStamper>(topic, point, index, subscribers,
                                                                          wall);
}

std::shared_ptr<void> Ros1Node::publish_points(const std::string& topic, const Map& map) {
  using Message = coupler_driver::Points;
  const auto publisher = std::make_shared<TopicPublisher>(advertise_latched<Message>(handle_, topic));
  publisher->publish(points_of<Message>(map, [](const Point& point) {
    return with_message<Ros1Messages>(point, [](auto kind) -> std::string {
      return ros::message_traits::datatype<typename decltype(kind)::Message>();
    });
  }));
  note_published<Message>(topic);
  return publisher;
}

std::shared_ptr<void> Ros1Node::subscribe(const std::string& topic, const Map& map, std::uint32_t index,
                                          const WriteHandler& handler) {
  return with_message<Ros1Messages>(map.points[index], [&](auto kind) {
    using Kind = decltype(kind);
    auto options =
        subscribe_options<typename Kind::Message>(topic, writes_per_value * map.points[index].host.queue_size,
                                                  [topic, &map, index, &handler](const auto& message) {
                                                    receive<Kind>(message, topic, map, index, handler);
                                                  });
    options.callback_queue = &InPlaceQueue::instance();
    // Otherwise ROS may ask to try again, which the queue cannot do.
    options.allow_concurrent_callbacks = true;
    options.transport_hints = ros::TransportHints().tcpNoDelay();
    topics_.add_written(handle_.resolveName(topic), ros::message_traits::datatype<typename Kind::Message>(),
                        map.points[index]);
    remappings_.add_name(topic, true);
    return std::shared_ptr<void>(std::make_shared<ros::Subscriber>(handle_.subscribe(options)));
  });
}

std::function<void(bool)> Ros1Node::advertise_online(const std::string& topic) {
  note_published<std_msgs::Bool>(topic);
  return online_with<std_msgs::Bool>(advertise_latched<std_msgs::Bool>(handle_, topic));
}

Node::PublishStatus Ros1Node::advertise_status(const std::string& topic, const Map& map) {
  using Message = coupler_driver::Status;
  note_published<Message>(topic);
  devices_.emplace_back(map.name);
  topics_.add_device(handle_.resolveName(devices_.back(), false), map);
  return status_with<Message>(advertise_latched<Message>(handle_, topic), map, ros::Time::now);
}

Node::PublishScheduled Ros1Node::advertise_scheduled(const std::string& topic, const Map& map,
                                                     const WallTime& wall) {
  using Message = coupler_driver::Scheduled;
  note_published<Message>(topic);
  return scheduled_with<Message>(handle_.advertise<Message>(topic, max_scheduled), map, wall);
}

Node::PublishToolState Ros1Node::advertise_tool_state(const std::string& topic) {
  using Message = coupler_driver::ToolState;
  note_published<Message>(topic);
  return tool_state_with<Message>(advertise_latched<Message>(handle_, topic));
}

Node::PublishJoints Ros1Node::advertise_joints(const std::string& topic) {
  using Message = sensor_msgs::JointState;
  note_published<Message>(topic);
  return joints_with<Message>(handle_.advertise<Message>(topic, joints_depth));
}

std::unique_ptr<ServiceThread> Ros1Node::make_service_thread(std::size_t calls) {
  return std::make_unique<Ros1ServiceThread>(handle_, remappings_, calls);
}

void Ros1Node::add_diagnostics(const std::string& name, std::function<DiagnosticEntry()> make) {
  diagnostics_.add(name, [make = std::move(make)](diagnostic_updater::DiagnosticStatusWrapper& status) {
    fill<diagnostic_msgs::DiagnosticStatus>(status, make());
  });
}

void Ros1Node::start() {
  for (const std::string& line : remappings_.unused(devices_)) log(Level::warning, line);
  master_.emplace(*this, topics_);
}

void Ros1Node::shut_down() {
  master_.reset();  // it must not register the node again after the end
  ros::shutdown();
}

void Ros1Node::log(Level level, const std::string& raw) {
  const std::string text = printable_lines(raw);
  // ROS's log has ended then, but the results of safe values are still to be reported.
  if (ros::isShuttingDown()) {
    const std::string_view kind = level == Level::error     ? "ERROR"
                                  : level == Level::warning ? " WARN"
                                                            : " INFO";
    std::fputs(fmt::format("[{}] {}\n", kind, text).c_str(), stderr);
    return;
  }
  switch (level) {
    case Level::info: return log_info(text);
    case Level::warning: return log_warning(text);
    case Level::error: return log_error(text);
  }
}

bool Ros1Node::shows_debug() const {
  ROSCONSOLE_DEFINE_LOCATION(true, ros::console::levels::Debug, ROSCONSOLE_DEFAULT_NAME);
  return __rosconsole_define_location__enabled;
}

void Ros1Node::log_debug(const std::string& text) { ROS_DEBUG("%s", printable_lines(text).c_str()); }

}  // namespace coupler::host
