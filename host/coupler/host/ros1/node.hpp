// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coupler/host/ros/node.hpp"
#include "coupler/host/ros/remapping_check.hpp"
#include "coupler/host/ros/topic_check.hpp"
#include "coupler/host/ros1/master_watch.hpp"

namespace coupler::host {

/// The node of this program in ROS 1, once ros::start() has been called.
class Ros1Node : public Node {
 public:
  Ros1Node();

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
  void publish_diagnostics() override { diagnostics_.force_update(); }
  void start() override;
  bool is_running() const override { return ros::ok(); }
  void shut_down() override;

  void log(Level level, const std::string& text) override;
  bool shows_debug() const override;
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

  void note_action(const std::string& name);

  ros::NodeHandle handle_;
  TopicCheck topics_;
  RemappingCheck remappings_;
  std::vector<std::string> devices_;  ///< their names
  ros::ServiceServer loggers_;
  diagnostic_updater::Updater diagnostics_;
  std::optional<MasterWatch> master_;
};

}  // namespace coupler::host
