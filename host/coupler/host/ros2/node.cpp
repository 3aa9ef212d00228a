// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/node.hpp"

#include <rcutils/logging.h>
#include <coupler_driver/msg/points.hpp>
#include <coupler_driver/msg/scheduled.hpp>
#include <coupler_driver/msg/status.hpp>
#include <coupler_driver/msg/tool_state.hpp>
#include <coupler_driver/srv/cancel_scheduled.hpp>
#include <coupler_driver/srv/list_scheduled.hpp>
#include <coupler_driver/srv/read.hpp>
#include <coupler_driver/srv/schedule.hpp>
#include <coupler_driver/srv/write.hpp>
#include <rcl_interfaces/msg/parameter_type.hpp>
#include <sensor_msgs/msg/joint_state.hpp>
#include <std_srvs/srv/set_bool.hpp>
#include <std_srvs/srv/trigger.hpp>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/ros/node_templates.hpp"
#include "coupler/host/ros/point_info.hpp"
#include "coupler/host/ros/topic_depth.hpp"
#include "coupler/host/ros2/messages.hpp"
#include "coupler/host/ros2/rcl/service.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::host {
namespace {

constexpr std::size_t diagnostics_depth = 10;

struct Ros2Services {
  using Write = coupler_driver::srv::Write;
  using Read = coupler_driver::srv::Read;
  using Schedule = coupler_driver::srv::Schedule;
  using CancelScheduled = coupler_driver::srv::CancelScheduled;
  using ListScheduled = coupler_driver::srv::ListScheduled;
  using SetBool = std_srvs::srv::SetBool;
  using Trigger = std_srvs::srv::Trigger;
};

class Ros2ServiceThread : public TypedServiceThread<Ros2ServiceThread, Ros2Services> {
 public:
  Ros2ServiceThread(rcl::Node& node, RemappingCheck& remappings, std::size_t threads)
      : node_(node), remappings_(remappings), most_(threads) {}
  ~Ros2ServiceThread() override {
    Ros2ServiceThread::stop();
    for (std::thread& thread : threads_) thread.join();
  }
  Ros2ServiceThread(const Ros2ServiceThread&) = delete;
  Ros2ServiceThread& operator=(const Ros2ServiceThread&) = delete;

  void start() override {
    while (threads_.size() < most_) threads_.emplace_back([this] { run(); });
  }
  void stop() override {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
      calls_.clear();
    }
    changed_.notify_all();
  }

  template <class S, class Function>
  void serve(const std::string& name, Function function) {
    remappings_.add_name(name, false);
    services_.push_back(rcl::offer<S>(node_, name, std::move(function), [this](std::function<void()> call) {
      const std::lock_guard lock(mutex_);
      if (stopped_) return;
      calls_.push_back(std::move(call));
      changed_.notify_one();
    }));
  }

 private:
  void run() {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [this] { return stopped_ || !calls_.empty(); });
      if (stopped_) return;
      const auto call = std::move(calls_.front());
      calls_.pop_front();
      lock.unlock();
      call();
      lock.lock();
    }
  }

  rcl::Node& node_;
  RemappingCheck& remappings_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> calls_;
  bool stopped_ = false;
  std::vector<std::shared_ptr<void>> services_;
  const std::size_t most_;            ///< threads
  std::vector<std::thread> threads_;  // last: they use the others
};

}  // namespace

Ros2Node::Ros2Node(rcl::Context& context, const std::string& name)
    : node_(context, name),
      shows_debug_(rcutils_logging_logger_is_enabled_for(rcl_node_get_logger_name(node_.get()),
                                                         RCUTILS_LOG_SEVERITY_DEBUG)),
      clock_(node_),
      parameters_(std::make_unique<ParameterServer>(node_, clock_, warn_subscriber(false))),
      type_descriptions_(rcl::offer_type_descriptions(node_)),
      diagnostics_(node_, "/diagnostics", rcl::reliable(diagnostics_depth), {{}, warn_subscriber(false)}) {
  node_.inbox().start();
}

void Ros2Node::declare_sim_time(bool use_sim_time) {
  ParameterServer::Descriptor descriptor;
  descriptor.name = "use_sim_time";
  descriptor.type = rcl_interfaces::msg::ParameterType::PARAMETER_BOOL;
  descriptor.description = "stamps of status and diagnostics follow /clock; nothing else does";
  ParameterServer::Value value;
  value.type = descriptor.type;
  value.bool_value = use_sim_time;
  clock_.use_simulated(use_sim_time);
  parameters_->declare(std::move(descriptor), value,
                       [this](const ParameterServer::Value& now) { clock_.use_simulated(now.bool_value); });
}

void Ros2Node::check_remappings(std::vector<Remapping> given) {
  remappings_ = RemappingCheck(std::move(given), rcl_node_get_namespace(node_.get()));
}

template <class Message>
void Ros2Node::note_published(const std::string& topic, const Point* point) {
  topics_.add_published(node_.full_topic(topic), rosidl_generator_traits::name<Message>(), point);
  remappings_.add_name(topic, point != nullptr);
}

template <class Publisher>
std::unique_ptr<PointPublisher> Ros2Node::advertise_as(const std::string& topic, const Point& point,
                                                       std::unique_ptr<Publisher> publisher,
                                                       bool is_stamped) {
  const auto matched = [p = publisher.get()](bool came) {
    came ? p->add_subscriber() : p->remove_subscriber();
  };
  const bool latch = point.host.latch;
  const rmw_qos_profile_t qos = latch ? rcl::latched() : rcl::reliable(topic_depth(point));
  publisher->set_publisher({node_, topic, qos, {matched, warn_subscriber(!latch)}});
  note_published<typename Publisher::Message>(topic, is_stamped ? nullptr : &point);
  return publisher;
}

std::unique_ptr<PointPublisher> Ros2Node::advertise(const std::string& topic, const Point& point,
                                                    std::uint32_t index, SubscriberCounts& subscribers) {
  return with_message<Ros2Messages>(point, [&](auto kind) {
    using Kind = decltype(kind);
    using Publisher = TypedPublisher<Kind, rcl::Publisher<typename Kind::Message>>;
    return advertise_as(topic, point, std::make_unique<Publisher>(point, index, subscribers), false);
  });
}

template <class Messages, class PutStamp>
std::unique_ptr<PointPublisher> Ros2Node::advertise_with_time(const std::string& topic, const Point& point,
                                                              std::uint32_t index,
                                                              SubscriberCounts& subscribers,
                                                              const WallTime& wall) {
  return with_stamped_message<Messages>(point, [&](auto kind) {
    using Kind = decltype(kind);
    using Publisher = TypedPublisher<Kind, rcl::Publisher<typename Kind::Message>, PutStamp>;
    return advertise_as(topic, point, std::make_unique<Publisher>(point, index, subscribers, PutStamp(wall)),
                        true);
  });
}

std::unique_ptr<PointPublisher> Ros2Node::advertise_stamped(const std::string& topic, const Point& point,
                                                            std::uint32_t index,
                                                            SubscriberCounts& subscribers,
                                                            const WallTime& wall) {
  return advertise_with_time<Ros2Messages, Stamper>(topic, point, index, subscribers, wall);
}

std::unique_ptr<PointPublisher> Ros2Node::advertise_sample(const std::string& topic, const Point& point,
                                                           std::uint32_t index, SubscriberCounts& subscribers,
                                                           const WallTime& wall) {
  return advertise_with_time<SampleMessages<Ros2Messages>, SampleStamper>(topic, point, index, subscribers,
                                                                          wall);
}

std::shared_ptr<void> Ros2Node::publish_points(const std::string& topic, const Map& map) {
  using Message = coupler_driver::msg::Points;
  const auto publisher = std::make_shared<rcl::Publisher<Message>>(
      node_, topic, rcl::latched(), rcl::PublisherEvents{{}, warn_subscriber(false)});
  publisher->publish(points_of<Message>(map, [](const Point& point) {
    return with_message<Ros2Messages>(point, [](auto kind) -> std::string {
      return rosidl_generator_traits::name<typename decltype(kind)::Message>();
    });
  }));
  note_published<Message>(topic);
  return publisher;
}

std::shared_ptr<void> Ros2Node::subscribe(const std::string& topic, const Map& map, std::uint32_t index,
                                          const WriteHandler& handler) {
  return with_message<Ros2Messages>(map.points[index], [&](auto kind) -> std::shared_ptr<void> {
    using Kind = decltype(kind);
    using Message = typename Kind::Message;
    topics_.add_written(node_.full_topic(topic), rosidl_generator_traits::name<Message>(), map.points[index]);
    remappings_.add_name(topic, true);
    const std::size_t depth = std::size_t{writes_per_value} * map.points[index].host.queue_size;
    return rcl::subscribe<Message>(
        node_, topic, rcl::reliable(depth),
        [topic, &map, index, &handler](const Message& message) {
          receive<Kind>(message, topic, map, index, handler);
        },
        warn_publisher());
  });
}

std::function<void(bool)> Ros2Node::advertise_online(const std::string& topic) {
  using Message = Ros2Messages::Bool;
  const rcl::Publisher<Message> publisher(node_, topic, rcl::latched(), {{}, warn_subscriber(false)});
  online_topics_.push_back(publisher.topic());
  note_published<Message>(topic);
  return online_with<Message>(publisher);
}

Node::PublishStatus Ros2Node::advertise_status(const std::string& topic, const Map& map) {
  using Message = coupler_driver::msg::Status;
  note_published<Message>(topic);
  devices_.emplace_back(map.name);
  topics_.add_device(node_.full_topic(devices_.back(), false), map);
  return status_with<Message>(
      rcl::Publisher<Message>(node_, topic, rcl::latched(), {{}, warn_subscriber(false)}), map,
      [this] { return clock_.now(); });
}

Node::PublishScheduled Ros2Node::advertise_scheduled(const std::string& topic, const Map& map,
                                                     const WallTime& wall) {
  using Message = coupler_driver::msg::Scheduled;
  note_published<Message>(topic);
  return scheduled_with<Message>(
      rcl::Publisher<Message>(node_, topic, rcl::reliable(max_scheduled), {{}, warn_subscriber(false)}), map,
      wall);
}

Node::PublishToolState Ros2Node::advertise_tool_state(const std::string& topic) {
  using Message = coupler_driver::msg::ToolState;
  note_published<Message>(topic);
  return tool_state_with<Message>(
      rcl::Publisher<Message>(node_, topic, rcl::latched(), {{}, warn_subscriber(false)}));
}

Node::PublishJoints Ros2Node::advertise_joints(const std::string& topic) {
  using Message = sensor_msgs::msg::JointState;
  note_published<Message>(topic);
  return joints_with<Message>(
      rcl::Publisher<Message>(node_, topic, rcl::reliable(joints_depth), {{}, warn_subscriber(false)}));
}

std::unique_ptr<ServiceThread> Ros2Node::make_service_thread(std::size_t calls) {
  return std::make_unique<Ros2ServiceThread>(node_, remappings_, calls);
}

void Ros2Node::add_diagnostics(const std::string& name, std::function<DiagnosticEntry()> make) {
  entries_.emplace_back(fmt::format("{}: {}", node_.name(), name), std::move(make));
}

void Ros2Node::publish_diagnostics() {
  diagnostic_msgs::msg::DiagnosticArray message;
  message.header.stamp = clock_.now();
  for (const auto& [name, make] : entries_) {
    auto& status = message.status.emplace_back();
    status.name = name;
    fill(status, make());
  }
  diagnostics_.publish(message);
}

void Ros2Node::start() {
  for (const std::string& line : remappings_.unused(devices_)) log(Level::warning, line);
  graph_watch_.emplace(*this, node_, topics_, online_topics_);
}

void Ros2Node::shut_down() {
  graph_watch_.reset();
  node_.inbox().stop();
}

rcl::OnIncompatible Ros2Node::warn_subscriber(bool could_latch) {
  return [this, could_latch, warned = false](const std::string& topic, const std::string& policy) mutable {
    if (std::exchange(warned, true)) return;
    const bool wants_latched = could_latch && policy == "durability";
    log(Level::warning,
        fmt::format("a subscriber of {} requests a {} that is not offered, and receives nothing; {}", topic,
                    policy,
                    wants_latched
                        ? "subscribe with durability volatile, or set 'latch: true' for the point in the map"
                        : "subscribe with reliable, volatile, keep last"));
  };
}

rcl::OnIncompatible Ros2Node::warn_publisher() {
  return [this, warned = false](const std::string& topic, const std::string& policy) mutable {
    if (std::exchange(warned, true)) return;
    log(Level::warning,
        fmt::format(
            "a publisher of {} does not offer the {} that is needed, and none of its messages is written; "
            "publish with reliability reliable",
            topic, policy));
  };
}

void Ros2Node::log(Level level, const std::string& text) {
  const int severity = level == Level::info      ? RCUTILS_LOG_SEVERITY_INFO
                       : level == Level::warning ? RCUTILS_LOG_SEVERITY_WARN
                                                 : RCUTILS_LOG_SEVERITY_ERROR;
  node_.log(severity, printable_lines(text));
}
void Ros2Node::log_debug(const std::string& text) {
  node_.log(RCUTILS_LOG_SEVERITY_DEBUG, printable_lines(text));
}

}  // namespace coupler::host
