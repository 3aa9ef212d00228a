// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/node.hpp"

#include <rcutils/logging.h>
#include <coupler_driver/msg/status.hpp>
#include <rcl_interfaces/msg/parameter_type.hpp>

#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/ros/node_templates.hpp"
#include "coupler/host/ros/status.hpp"
#include "coupler/host/ros2/messages.hpp"
#include "coupler/host/ros2/rcl/service.hpp"
#include "coupler/host/ros2/service_thread.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::host {
namespace {

using diagnostic_msgs::msg::DiagnosticStatus;

constexpr std::size_t diagnostics_depth = 10;
constexpr auto graph_watch_interval = std::chrono::seconds(2);

std::uint8_t diagnostic_level(Level level) {
  switch (level) {
    case Level::info: return DiagnosticStatus::OK;
    case Level::warning: return DiagnosticStatus::WARN;
    case Level::error: break;
  }
  return DiagnosticStatus::ERROR;
}

int severity(Level level) {
  switch (level) {
    case Level::info: return RCUTILS_LOG_SEVERITY_INFO;
    case Level::warning: return RCUTILS_LOG_SEVERITY_WARN;
    case Level::error: break;
  }
  return RCUTILS_LOG_SEVERITY_ERROR;
}

std::string_view policy_name(rmw_qos_policy_kind_t policy) {
  switch (policy) {
    case RMW_QOS_POLICY_DURABILITY: return "durability";
    case RMW_QOS_POLICY_DEADLINE: return "deadline";
    case RMW_QOS_POLICY_LIVELINESS: return "liveliness";
    case RMW_QOS_POLICY_RELIABILITY: return "reliability";
    default: return "QoS";
  }
}

/// Shared, so that a function that holds it may be copied.
template <class M>
std::shared_ptr<rcl::Publisher<M>> make_publisher(rcl::Node& node, const std::string& topic,
                                                  const rmw_qos_profile_t& qos,
                                                  rcl::AnyPublisher::Events events) {
  return std::make_shared<rcl::Publisher<M>>(node, topic, qos, std::move(events));
}

/// What TypedPublisher publishes with.
template <class M>
struct Owned {
  std::shared_ptr<rcl::Publisher<M>> publisher;
  void publish(const M& message) { publisher->publish(message); }
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

Ros2Node::~Ros2Node() { Ros2Node::shut_down(); }

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

std::unique_ptr<PointPublisher> Ros2Node::advertise(const std::string& topic, const Point& point,
                                                    std::uint32_t index, SubscriberCounts& subscribers) {
  return with_message<Ros2Messages>(point, [&](auto kind) -> std::unique_ptr<PointPublisher> {
    using Kind = decltype(kind);
    using Message = typename Kind::Message;
    auto publisher = std::make_unique<TypedPublisher<Kind, Owned<Message>>>(point, index, subscribers);
    const auto matched = [p = publisher.get()](int by) {
      for (; by > 0; --by) p->add_subscriber();
      for (; by < 0; ++by) p->remove_subscriber();
    };
    const bool latch = point.host.latch;
    publisher->set_publisher(
        {make_publisher<Message>(node_, topic, latch ? rcl::latched() : rcl::reliable(point.host.queue_size),
                                 {matched, warn_subscriber(!latch)})});
    return publisher;
  });
}

std::shared_ptr<void> Ros2Node::subscribe(const std::string& topic, const Map& map, std::uint32_t index,
                                          const WriteHandler& handler) {
  return with_message<Ros2Messages>(map.points[index], [&](auto kind) -> std::shared_ptr<void> {
    using Kind = decltype(kind);
    using Message = typename Kind::Message;
    const std::size_t depth = std::size_t{writes_per_value} * map.points[index].host.queue_size;
    return std::make_shared<rcl::Subscription<Message>>(
        node_, topic, rcl::reliable(depth),
        [topic, &map, index, &handler](const Message& message) {
          receive<Kind>(message, topic, map, index, handler);
        },
        warn_publisher());
  });
}

std::function<void(bool)> Ros2Node::advertise_online(const std::string& topic) {
  using Bool = Ros2Messages::Bool;
  const auto publisher = make_publisher<Bool>(node_, topic, rcl::latched(), {{}, warn_subscriber(false)});
  online_topics_.push_back(publisher->topic());
  return [publisher](bool online) {
    Bool message;
    message.data = online;
    publisher->publish(message);
  };
}

Node::PublishStatus Ros2Node::advertise_status(const std::string& topic, const Map& map) {
  using Message = coupler_driver::msg::Status;
  const auto status = std::make_shared<Status<Message>>(map);
  const auto publisher = make_publisher<Message>(node_, topic, rcl::latched(), {{}, warn_subscriber(false)});
  return [this, status, publisher](const DeviceSnapshot& device, const std::vector<PointQuality>& points,
                                   Time now) {
    if (!status->update(device, points, now)) return false;
    status->message().header.stamp = clock_.now();
    publisher->publish(status->message());
    return true;
  };
}

std::unique_ptr<ServiceThread> Ros2Node::make_service_thread() {
  return std::make_unique<Ros2ServiceThread>(node_);
}

void Ros2Node::add_diagnostics(const std::string& name, std::function<DiagnosticEntry()> make) {
  entries_.push_back({fmt::format("{}: {}", node_.name(), name), std::move(make)});
}

void Ros2Node::publish_diagnostics() {
  diagnostic_msgs::msg::DiagnosticArray message;
  message.header.stamp = clock_.now();
  for (const auto& [name, make] : entries_) {
    const DiagnosticEntry entry = make();
    DiagnosticStatus& status = message.status.emplace_back();
    status.level = diagnostic_level(entry.level);
    status.name = name;
    status.message = entry.message;
    status.hardware_id = entry.hardware_id;
    for (const auto& [key, value] : entry.values) {
      auto& added = status.values.emplace_back();
      added.key = key;
      added.value = value;
    }
  }
  diagnostics_.publish(message);
}

void Ros2Node::start() {
  graph_watch_.emplace(graph_watch_interval, [this] { warn_of_duplicates(); });
}

void Ros2Node::shut_down() {
  graph_watch_.reset();
  node_.inbox().stop();
}

rcl::OnIncompatible Ros2Node::warn_subscriber(bool could_latch) {
  return [this, could_latch, warned = false](const std::string& topic, rmw_qos_policy_kind_t policy) mutable {
    if (std::exchange(warned, true)) return;
    const bool wants_latched = could_latch && policy == RMW_QOS_POLICY_DURABILITY;
    log(Level::warning,
        fmt::format("a subscriber of {} requests a {} that is not offered, and receives nothing; {}", topic,
                    policy_name(policy),
                    wants_latched
                        ? "subscribe with durability volatile, or set 'latch: true' for the point in the map"
                        : "subscribe with reliable, volatile, keep last"));
  };
}

rcl::OnIncompatible Ros2Node::warn_publisher() {
  return [this, warned = false](const std::string& topic, rmw_qos_policy_kind_t policy) mutable {
    if (std::exchange(warned, true)) return;
    log(Level::warning,
        fmt::format(
            "a publisher of {} does not offer the {} that is needed, and none of its messages is written; "
            "publish with reliability reliable",
            topic, policy_name(policy)));
  };
}

void Ros2Node::warn_of_duplicates() {
  std::vector<DuplicateDriver> duplicates;
  for (const std::string& topic : online_topics_) {
    bool is_first_own = true;
    for (const std::string& node : node_.publishers_of(topic)) {
      if (node.find("_UNKNOWN_") != std::string::npos) continue;  // the graph does not know its name yet
      if (node != node_.full_name())
        duplicates.push_back({topic, node});
      else if (!std::exchange(is_first_own, false))
        duplicates.push_back({topic, "another node " + node});
    }
  }
  duplicates_.update(duplicates, *this);
}

void Ros2Node::log(Level level, const std::string& text) {
  node_.log(severity(level), printable_lines(text));
}
void Ros2Node::log_debug(const std::string& text) {
  node_.log(RCUTILS_LOG_SEVERITY_DEBUG, printable_lines(text));
}

}  // namespace coupler::host
