// SPDX-License-Identifier: Apache-2.0
// What the driver needs of a ROS. coupler/host/ros1 and coupler/host/ros2 implement it.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "coupler/base/span.hpp"
#include "coupler/host/core/call_queue.hpp"
#include "coupler/host/core/clock.hpp"
#include "coupler/host/core/device_statistics.hpp"
#include "coupler/host/core/point_quality.hpp"
#include "coupler/host/core/scheduled.hpp"
#include "coupler/host/core/sink.hpp"
#include "coupler/host/core/wall_time.hpp"
#include "coupler/host/core/write.hpp"
#include "coupler/host/motion/tool_motion.hpp"
#include "coupler/host/ros/action.hpp"
#include "coupler/host/ros/sample.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// The topic of one readable point. It keeps its message, so that a value costs no allocation of ours.
class PointPublisher {
 public:
  virtual ~PointPublisher() = default;
  /// The point's registers as they were at the stamp; bit tables: each bit as one register, 0 or 1. Publishes
  /// them if the point's policy says so.
  virtual void publish(const std::uint16_t* registers, const Sample& sample) = 0;
  /// When publish() would publish the value of last time once more; Time::max(): never. From its thread.
  virtual Time repeat_at() const = 0;
  /// The next value is published whatever it is.
  virtual void renew() = 0;
  /// Nothing is known of the value from here to the next one. Any thread may call it.
  virtual void forget() = 0;
};

/// How many subscribers each point of a device has. A call that waits for the point's next value counts as
/// one. Any thread may call.
class SubscriberCounts {
 public:
  explicit SubscriberCounts(std::size_t points) : counts_(points) {}

  void add(std::uint32_t point) {
    const std::lock_guard lock(mutex_);
    if (counts_[point]++ == 0 && want_) want_(point, true);
    if (read_) read_(point);
  }
  void remove(std::uint32_t point) {
    const std::lock_guard lock(mutex_);
    if (--counts_[point] == 0 && want_) want_(point, false);
  }

  /// Calls `want(point, true)` for each point that has a subscriber now or gets its first one later, and
  /// `want(point, false)` when the last one has gone. `want` must not wait for anything.
  void follow(std::function<void(std::uint32_t point, bool wanted)> want) {
    const std::lock_guard lock(mutex_);
    want_ = std::move(want);
    for (std::uint32_t point = 0; point < counts_.size(); ++point)
      if (counts_[point] > 0) want_(point, true);
  }

  /// Calls `read(point)` for each subscriber that there is or that comes later: it has seen no value yet.
  /// `read` must not wait for anything.
  void on_each(std::function<void(std::uint32_t point)> read) {
    const std::lock_guard lock(mutex_);
    read_ = std::move(read);
    for (std::uint32_t point = 0; point < counts_.size(); ++point)
      if (counts_[point] > 0) read_(point);
  }

  /// The point has no subscriber, and after follow() that matters.
  bool is_unwanted(std::uint32_t point) const {
    const std::lock_guard lock(mutex_);
    return want_ && counts_[point] == 0;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::uint32_t> counts_;
  std::function<void(std::uint32_t, bool)> want_;
  std::function<void(std::uint32_t)> read_;
};

/// The functions that all subscriptions of a device call.
struct WriteHandler {
  std::function<void(const Write&)> accept;
  /// The value cannot be written: the point's index, if there is such a point, what was wrong and the remedy.
  std::function<void(std::optional<std::uint32_t> point, const std::string& what)> refuse;
};

/// Answers services in threads of its own, by default in one, so one call after the other: each may wait for
/// its result.
class ServiceThread {
 public:
  struct ReadAnswer {
    bool success = false;
    std::string value;
    std::string message;
  };
  /// A write that waits for its time.
  struct ListedWrite {
    std::uint32_t number = 0;
    std::string point;
    std::string value;
    std::chrono::nanoseconds due{};  ///< wall time
    std::chrono::nanoseconds how_long{};
    bool by_device = false;
  };
  struct ScheduleRequest {
    std::string point;
    std::string value;
    std::chrono::nanoseconds at{};  ///< wall time
    std::chrono::nanoseconds how_long{};
  };

  /// Waits for the call in progress.
  virtual ~ServiceThread() = default;

  // Before start(); offer_set() later, too.

  /// coupler_driver/Write: a point's name and its value as text.
  virtual void offer_write(
      const std::string& name,
      std::function<WriteTicket::Outcome(const std::string& point, const std::string& value)> call) = 0;
  /// coupler_driver/Schedule.
  virtual void offer_schedule(const std::string& name,
                              std::function<ScheduleAnswer(const ScheduleRequest&)> call) = 0;
  /// coupler_driver/CancelScheduled: the number of a write.
  virtual void offer_cancel(const std::string& name,
                            std::function<CallAnswer(std::uint32_t number)> call) = 0;
  /// coupler_driver/ListScheduled.
  virtual void offer_list(const std::string& name, std::function<std::vector<ListedWrite>()> call) = 0;
  /// coupler_driver/Read: a point's name.
  virtual void offer_read(const std::string& name,
                          std::function<ReadAnswer(const std::string& point)> call) = 0;
  /// std_srvs/SetBool.
  virtual void offer_set(const std::string& name, std::function<CallAnswer(bool on)> call) = 0;
  /// std_srvs/Trigger.
  virtual void offer_trigger(const std::string& name, std::function<CallAnswer()> call) = 0;

  virtual void start() = 0;
  /// Takes no more calls.
  virtual void stop() = 0;
};

/// An entry of /diagnostics (REP 107).
struct DiagnosticEntry {
  Level level = Level::info;  ///< OK, WARN or ERROR
  std::string message;
  std::string hardware_id;
  std::vector<std::pair<std::string, std::string>> values;
};

/// A node of either ROS. Names are relative, so that they can be remapped. ROS's threads use what is made
/// from a node until shut_down(): it must be destroyed after that, and before the node.
class Node {
 public:
  virtual ~Node() = default;

  /// The message type follows from the point. The point and `subscribers`, which counts those of the topic,
  /// must outlive the publisher.
  virtual std::unique_ptr<PointPublisher> advertise(const std::string& topic, const Point& point,
                                                    std::uint32_t index, SubscriberCounts& subscribers) = 0;
  /// The same with the stamps of the values: coupler_driver/BoolStamped and its relatives. `wall` must
  /// outlive the publisher, and is used where that publishes.
  virtual std::unique_ptr<PointPublisher> advertise_stamped(const std::string& topic, const Point& point,
                                                            std::uint32_t index,
                                                            SubscriberCounts& subscribers,
                                                            const WallTime& wall) = 0;
  /// The same with how the values are known: coupler_driver/BoolSample and its relatives.
  virtual std::unique_ptr<PointPublisher> advertise_sample(const std::string& topic, const Point& point,
                                                           std::uint32_t index, SubscriberCounts& subscribers,
                                                           const WallTime& wall) = 0;
  /// Publishes a coupler_driver/Points, latched. The topic lasts as long as the result.
  virtual std::shared_ptr<void> publish_points(const std::string& topic, const Map& map) = 0;
  /// To `map.points[index]`. The handler is called in ROS's network thread and must not wait for anything.
  /// The subscription lasts as long as the result; map and handler must outlive it.
  virtual std::shared_ptr<void> subscribe(const std::string& topic, const Map& map, std::uint32_t index,
                                          const WriteHandler& handler) = 0;
  /// std_msgs/Bool, latched.
  virtual std::function<void(bool)> advertise_online(const std::string& topic) = 0;
  /// coupler_driver/Status, latched. Published, and true, when a quality, the identity or `online` has
  /// changed and at least once a second. From one thread only.
  using PublishStatus =
      std::function<bool(const DeviceSnapshot&, const std::vector<PointQuality>&, Time now)>;
  virtual PublishStatus advertise_status(const std::string& topic, const Map& map) = 0;
  /// coupler_driver/Scheduled. From one thread only; `wall` must outlive the result, and has measured the
  /// time of what is published.
  using PublishScheduled = std::function<void(const ScheduledOutcome&)>;
  virtual PublishScheduled advertise_scheduled(const std::string& topic, const Map& map,
                                               const WallTime& wall) = 0;
  /// coupler_driver/ToolState, latched. From one thread only. `since` is wall time.
  using PublishToolState = std::function<void(const ToolStatus&, std::chrono::nanoseconds since)>;
  virtual PublishToolState advertise_tool_state(const std::string& topic) = 0;
  /// sensor_msgs/JointState. From one thread only; `stamp` is wall time.
  struct Joint {
    std::string_view name;
    double position;
  };
  using PublishJoints = std::function<void(Span<const Joint>, std::chrono::nanoseconds stamp)>;
  virtual PublishJoints advertise_joints(const std::string& topic) = 0;
  /// `calls`: how many it answers at a time.
  virtual std::unique_ptr<ServiceThread> make_service_thread(std::size_t calls = 1) = 0;
  /// Serves coupler_driver/WaitFor as long as the result exists.
  virtual std::unique_ptr<WaitForServer> offer_wait_for(const std::string& name,
                                                        WaitForServer::Handler handler) = 0;
  /// Serves control_msgs/GripperCommand. Null if the driver was built without control_msgs.
  virtual std::unique_ptr<GripperServer> offer_gripper(const std::string& name,
                                                       GripperServer::Handler handler) = 0;
  /// Serves control_msgs/ParallelGripperCommand for the joint. Null if it was built without that.
  virtual std::unique_ptr<GripperServer> offer_parallel_gripper(const std::string& name,
                                                                const std::string& joint,
                                                                GripperServer::Handler handler) = 0;
  /// Serves control_msgs/FollowJointTrajectory. Null if the driver was built without control_msgs.
  virtual std::unique_ptr<TrajectoryServer> offer_trajectories(const std::string& name,
                                                               TrajectoryServer::Handler handler) = 0;

  /// publish_diagnostics() calls `make` of every entry, in the order in which they were added. The entries of
  /// all devices are one message: a publisher of /diagnostics keeps only the newest.
  virtual void add_diagnostics(const std::string& name, std::function<DiagnosticEntry()> make) = 0;
  virtual void publish_diagnostics() = 0;

  /// All devices have their topics and services now.
  virtual void start() = 0;
  /// False once ROS has ended the node by itself.
  virtual bool is_running() const = 0;
  /// Takes no more messages and calls. The log still works.
  virtual void shut_down() = 0;

  // The log: console and /rosout, from any thread. The text may come from a device, so it is escaped as
  // printable_lines() does.
  virtual void log(Level level, const std::string& text) = 0;
  /// Returns whether log_debug() shows anything. The call is cheap.
  virtual bool shows_debug() const = 0;
  virtual void log_debug(const std::string& text) = 0;
};

}  // namespace coupler::host
