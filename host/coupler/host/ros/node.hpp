// SPDX-License-Identifier: Apache-2.0
// What the shared half of the driver needs of a ROS. coupler/host/ros1 and coupler/host/ros2 implement it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "coupler/host/core/calls.hpp"
#include "coupler/host/core/clock.hpp"
#include "coupler/host/core/device_statistics.hpp"
#include "coupler/host/core/point_quality.hpp"
#include "coupler/host/core/write.hpp"
#include "coupler/host/ros/listeners.hpp"
#include "coupler/host/ros/log.hpp"
#include "coupler/host/ros/write_handler.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// The topic of one readable point. It keeps its message, so that a value costs no allocation of ours.
class PointPublisher {
 public:
  virtual ~PointPublisher() = default;
  /// The point's registers as they came `at`; bit tables: each bit as one register, 0 or 1. Publishes them
  /// where the point's policy calls them news.
  virtual void publish(const std::uint16_t* registers, Time at) = 0;
  /// The next value is news whatever it is.
  virtual void renew() = 0;
};

/// Answers services in a thread of its own, one call after the other: each may wait for its result.
class ServiceThread {
 public:
  struct ReadAnswer {
    bool success = false;
    std::string value;
    std::string message;
  };

  /// Waits for the call in progress.
  virtual ~ServiceThread() = default;

  // Before start().

  /// coupler_driver/Write: a point's name and its value as text.
  virtual void offer_write(
      const std::string& name,
      std::function<WriteTicket::Outcome(const std::string& point, const std::string& value)> call) = 0;
  /// coupler_driver/Read: a point's name.
  virtual void offer_read(const std::string& name,
                          std::function<ReadAnswer(const std::string& point)> call) = 0;
  /// std_srvs/SetBool.
  virtual void offer_set(const std::string& name, std::function<Calls::Answer(bool on)> call) = 0;
  /// std_srvs/Trigger.
  virtual void offer_trigger(const std::string& name, std::function<Calls::Answer()> call) = 0;

  virtual void start() = 0;
  /// Takes no more calls.
  virtual void end() = 0;
};

/// An entry of /diagnostics (REP 107).
struct Diagnosis {
  Level level = Level::info;  ///< OK, WARN or ERROR
  std::string text;
  std::string hardware_id;
  std::vector<std::pair<std::string, std::string>> figures;
};

/// A node of either ROS. Names are relative, so that they can be remapped. What is made from it must go
/// before it does, and after shut_down(), because ROS's threads use it until then.
class Node : public Log {
 public:
  /// The message type follows from the point. `listeners` is told who comes and who leaves; it and the point
  /// must outlive the publisher.
  virtual std::unique_ptr<PointPublisher> advertise(const std::string& topic, const Point& point,
                                                    std::uint32_t index, Listeners& listeners) = 0;
  /// To `map.points[index]`. The handler is called in ROS's network thread and must wait for nothing. The
  /// subscription lasts as long as what is returned; map and handler must outlive it.
  virtual std::shared_ptr<void> subscribe(const std::string& topic, const Map& map, std::uint32_t index,
                                          const WriteHandler& handler) = 0;
  /// std_msgs/Bool, latched.
  virtual std::function<void(bool)> advertise_online(const std::string& topic) = 0;
  /// coupler_driver/Status, latched; published when a quality, the identity or `online` is not what it was,
  /// and after a second: then true. To be called from one thread.
  using PublishStatus =
      std::function<bool(const DeviceSnapshot&, const std::vector<PointQuality>&, Time now)>;
  virtual PublishStatus advertise_status(const std::string& topic, const Map& map) = 0;
  virtual std::unique_ptr<ServiceThread> make_service_thread() = 0;

  /// The entries of all devices are one message: a publisher of /diagnostics keeps only the newest. `tell` is
  /// called by publish_diagnostics(), in the order in which they were added.
  virtual void add_diagnosis(const std::string& name, std::function<Diagnosis()> tell) = 0;
  virtual void publish_diagnostics() = 0;

  /// All devices have their topics and services now.
  virtual void begin() = 0;
  /// False once ROS has ended the node by itself.
  virtual bool is_running() const = 0;
  /// Takes no more messages and calls. The log still works.
  virtual void shut_down() = 0;
};

}  // namespace coupler::host
