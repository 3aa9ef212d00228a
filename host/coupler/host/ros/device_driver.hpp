// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "coupler/base/log_line_limit.hpp"
#include "coupler/host/core/device_thread.hpp"
#include "coupler/host/core/pace.hpp"
#include "coupler/host/core/value_table.hpp"
#include "coupler/host/core/wall_time.hpp"
#include "coupler/host/ros/device_recording.hpp"
#include "coupler/host/ros/device_services.hpp"
#include "coupler/host/ros/diagnostics.hpp"
#include "coupler/host/ros/node.hpp"

namespace coupler::host {

/// One device in ROS: `<name>/<point>` for each readable point, with `<name>/<point>/stamped` and
/// `<name>/<point>/sample` where the map says so, `<name>/points`, `<name>/<point>/write` for each writable
/// one, the latched `<name>/online` and `<name>/status`,
/// `<name>/scheduled`, services, diagnostics, and the thread that drives the device. Values are published in
/// that thread as they are decoded.
class DeviceDriver : public Sink {
 public:
  /// The readers of its values besides ROS.
  struct Followed {
    std::optional<std::string> recording;  ///< the path of one
    std::optional<unsigned> panel;         ///< the port of one
  };

  /// Offers its topics; starts nothing before begin(). `topics`: see choose_points(). The map's views must
  /// outlive it. Callbacks of the node refer to it: the node must be shut down before it is destroyed, and
  /// publish no more diagnostics.
  DeviceDriver(Node& node, const Map& map, std::unique_ptr<Link> link,
               const std::vector<std::string>& topics);
  ~DeviceDriver() override { services_.stop(); }

  /// Connects to the device, listens to what is to be written, and offers services, which takes as long as
  /// ROS takes. Nothing, if Shutdown::requested. Throws std::system_error if no thread can be had.
  void begin(const Followed& followed);

  /// After stop(): its outputs are safe, however long the disk takes.
  void end_followers();

  /// Stops the device's thread; what comes from ROS afterwards does nothing. False if an output should have
  /// its safe value and has not.
  bool stop();

  /// Does the part of it that the device needs. Any thread may call it, also while another is in begin().
  bool stop_device() { return thread_.end(); }

  /// Publishes the status if it is due, and updates the diagnostics: true if they are to be published at
  /// once. To be called about ten times a second; without news and without `force` it does nothing.
  bool report(Time now, bool force);

  void on_values(Span<const std::uint32_t> points) override;
  void on_told(std::uint32_t point) override;
  void on_gap() override;
  void on_no_values(Span<const std::uint32_t> points, Time at) override;
  Time repeat_at(std::uint32_t point) const override;
  void on_identified(Identity::Verdict verdict) override;
  void on_online(bool online) override;
  void on_scheduled(const ScheduledOutcome& outcome) override;
  void on_loss(const std::string& why) override;
  void on_report(Level level, const std::string& text) override;

 private:
  void log(Level level, const std::string& text);
  DeviceThread& driven();
  void start_followers(const Followed& followed);
  void publish(Span<const std::uint32_t> points, bool is_told);
  void renew(std::uint32_t point);
  void forget(std::uint32_t point);
  void check_text(std::uint32_t point);
  void measure_wall();
  void accept(const Write& write);
  std::future<CallAnswer> make_safe();
  std::future<ScheduleAnswer> schedule(const ScheduledWrite& what);
  void say_refused(const std::string& what);
  void refuse(std::optional<std::uint32_t> point, const std::string& what);

  Node& node_;
  Map map_;
  ValueTable values_;
  SubscriberCounts subscribers_;
  const std::vector<bool> has_topics_;                       ///< by point
  std::vector<std::unique_ptr<PointPublisher>> publishers_;  ///< by point; null where it has no topic
  WallTime wall_;
  LogLineLimit wall_lines_;
  std::vector<std::unique_ptr<PointPublisher>> stamped_;  ///< by point; null where it is not stamped
  std::vector<std::unique_ptr<PointPublisher>> samples_;  ///< the same
  std::shared_ptr<void> points_;                          ///< the topic; null where a point has its name
  std::function<void(bool)> publish_online_;
  Node::PublishStatus publish_status_;
  Node::PublishScheduled publish_scheduled_;  ///< empty if no point can be written
  Diagnostics diagnostics_;
  Pace pace_;
  DeviceServices services_;
  std::vector<std::unique_ptr<Follower>> followers_;  ///< as they are when the thread starts
  std::unique_ptr<Link> link_;
  DeviceThread thread_;
  std::uint64_t reported_ = 0;  ///< the thread's revision
  Time stale_from_{};           ///< the first of the good points becomes stale
  Time status_due_{};
  WriteHandler writes_;
  LogLineLimit refused_lines_;
  std::set<std::uint32_t> odd_texts_;  ///< points whose text was not in their encoding, which was said
  std::vector<std::shared_ptr<void>> subscriptions_;
};

}  // namespace coupler::host
