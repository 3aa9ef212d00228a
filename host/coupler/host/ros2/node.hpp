// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <diagnostic_msgs/msg/diagnostic_array.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coupler/host/ros/node.hpp"
#include "coupler/host/ros/remapping_check.hpp"
#include "coupler/host/ros/topic_check.hpp"
#include "coupler/host/ros2/graph_watch.hpp"
#include "coupler/host/ros2/message_clock.hpp"
#include "coupler/host/ros2/parameter_server.hpp"
#include "coupler/host/ros2/rcl/topics.hpp"

namespace coupler::host {

/// The node of this program in ROS 2.
class Ros2Node : public Node {
 public:
  /// It is in the graph from now on, and its parameters can be read. Throws rcl::Error.
  Ros2Node(rcl::Context& context, const std::string& name);

  std::string name() const { return node_.name(); }
  std::string full_name() const { return node_.full_name(); }
  ParameterServer& parameters() { return *parameters_; }
  /// Declares the parameter; it may change while the node runs.
  void declare_sim_time(bool use_sim_time);
  /// Warns at start() of those that change nothing. To be called before anything is made in it.
  void check_remappings(std::vector<Remapping> given);

  std::unique_ptr<PointPublisher> advertise(const std::string& topic, const Point& point, std::uint32_t index,
                                            SubscriberCounts& subscribers) override;
  std::unique_ptr<PointPublisher> advertise_stamped(const std::string& topic, const Point& point,
                                                    std::uint32_t index, SubscriberCounts& subscribers,
                                                    const WallTime& wall) override;
  std::unique_ptr<PointPublisher> advertise_sample(const std::string& topic, const Point& point,
                                                   std::uint32_t index, SubscriberCounts& subscribers,
                                                   const WallTime& wall) override;
  std::shared_ptr<void> publish_points(const std::string& topic, const Map& map) override;
  std::shared_ptr<void> subscribe(const std::string& topic, const Map& map, std::uint32_t index,
                                  const WriteHandler& handler) override;
  std::function<void(bool)> advertise_online(const std::string& topic) override;
  PublishStatus advertise_status(const std::string& topic, const Map& map) override;
  PublishScheduled advertise_scheduled(const std::string& topic, const Map& map,
                                       const WallTime& wall) override;
  PublishToolState advertise_tool_state(const std::string& topic) override;
  PublishJoints advertise_joints(const std::string& topic) override;
  std::unique_ptr<ServiceThread> make_service_thread(std::size_t calls) override;
  std::unique_ptr<WaitForServer> offer_wait_for(const std::string& name,
                                                WaitForServer::Handler handler) override;
  std::unique_ptr<GripperServer> offer_gripper(const std::string& name,
                                               GripperServer::Handler handler) override;
  std::unique_ptr<GripperServer> offer_parallel_gripper(const std::string& name, const std::string& joint,
                                                        GripperServer::Handler handler) override;
  std::unique_ptr<TrajectoryServer> offer_trajectories(const std::string& name,
                                                       TrajectoryServer::Handler handler) override;
  void add_diagnostics(const std::string& name, std::function<DiagnosticEntry()> make) override;
  void publish_diagnostics() override;
  void start() override;
  bool is_running() const override { return true; }
  void shut_down() override;

  void log(Level level, const std::string& text) override;
  bool shows_debug() const override { return shows_debug_; }
  void log_debug(const std::string& text) override;

 private:
  template <class Messages, class PutStamp>
  std::unique_ptr<PointPublisher> advertise_with_time(const std::string& topic, const Point& point,
                                                      std::uint32_t index, SubscriberCounts& subscribers,
                                                      const WallTime& wall);
  template <class Publisher>
  std::unique_ptr<PointPublisher> advertise_as(const std::string& topic, const Point& point,
                                               std::unique_ptr<Publisher> publisher, bool is_stamped);
  /// `point`: null where the topic is not that of a point's values.
  template <class Message>
  void note_published(const std::string& topic, const Point* point = nullptr);
  rcl::OnIncompatible warn_subscriber(bool could_latch);
  rcl::OnIncompatible warn_publisher();

  rcl::Node node_;
  bool shows_debug_;
  MessageClock clock_;
  std::unique_ptr<ParameterServer> parameters_;
  std::shared_ptr<void> type_descriptions_;
  rcl::Publisher<diagnostic_msgs::msg::DiagnosticArray> diagnostics_;
  std::vector<std::pair<std::string, std::function<DiagnosticEntry()>>> entries_;  ///< by name
  std::vector<std::string> online_topics_;                                         ///< with their namespaces
  TopicCheck topics_;
  RemappingCheck remappings_;
  std::vector<std::string> devices_;       ///< their names
  std::optional<GraphWatch> graph_watch_;  // last: it uses the others
};

}  // namespace coupler::host
