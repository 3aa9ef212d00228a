// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <diagnostic_msgs/msg/diagnostic_array.hpp>

#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "coupler/host/ros/node.hpp"
#include "coupler/host/ros2/message_clock.hpp"
#include "coupler/host/ros2/parameter_server.hpp"
#include "coupler/host/ros2/rcl/publisher.hpp"
#include "coupler/host/ros2/rivals.hpp"

namespace coupler::host {

/// The node of this program in ROS 2.
class Ros2Node : public Node {
 public:
  /// It is in the graph from now on, and its parameters can be asked for. Throws rcl::Error.
  Ros2Node(rcl::Context& context, const std::string& name);
  ~Ros2Node() override;
  Ros2Node(const Ros2Node&) = delete;
  Ros2Node& operator=(const Ros2Node&) = delete;

  std::string full_name() const { return node_.full_name(); }
  ParameterServer& parameters() { return *parameters_; }
  /// Declares the parameter; it may change while the node runs.
  void declare_sim_time(bool use_sim_time);

  std::unique_ptr<PointPublisher> advertise(const std::string& topic, const Point& point, std::uint32_t index,
                                            Listeners& listeners) override;
  std::shared_ptr<void> subscribe(const std::string& topic, const Map& map, std::uint32_t index,
                                  const WriteHandler& handler) override;
  std::function<void(bool)> advertise_online(const std::string& topic) override;
  PublishStatus advertise_status(const std::string& topic, const Map& map) override;
  std::unique_ptr<ServiceThread> make_service_thread() override;
  void add_diagnosis(const std::string& name, std::function<Diagnosis()> tell) override;
  void publish_diagnostics() override;
  void begin() override;
  bool is_running() const override { return true; }
  void shut_down() override;

  void log(Level level, const std::string& text) override;
  bool shows_debug() const override { return shows_debug_; }
  void log_debug(const std::string& text) override;

 private:
  rcl::Incompatible warn_subscriber(bool could_latch);
  rcl::Incompatible warn_publisher();

  rcl::Node node_;
  bool shows_debug_;
  MessageClock clock_;
  std::unique_ptr<ParameterServer> parameters_;
  std::shared_ptr<void> type_descriptions_;
  rcl::Publisher<diagnostic_msgs::msg::DiagnosticArray> diagnostics_;
  struct Entry {
    std::string name;
    std::function<Diagnosis()> tell;
  };
  std::vector<Entry> entries_;
  Rivals rivals_;
};

}  // namespace coupler::host
