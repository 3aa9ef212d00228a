// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "coupler/base/line_limit.hpp"
#include "coupler/host/core/device_thread.hpp"
#include "coupler/host/ros/device_services.hpp"
#include "coupler/host/ros/diagnostics.hpp"
#include "coupler/host/ros/node.hpp"
#include "coupler/host/ros/traced_transport.hpp"

namespace coupler::host {

/// One device in ROS: `<name>/<point>` for each readable point, `<name>/<point>/write` for each writable one,
/// the latched `<name>/online` and `<name>/status`, services, diagnostics, and the thread that drives the
/// device. Values are published in that thread as they are decoded.
class DeviceTopics : public Sink {
 public:
  /// The map's views must outlive it; the node must have been shut down before it ends, since callbacks refer
  /// to it, and publish no diagnostics any more.
  DeviceTopics(Node& node, const Map& map, std::unique_ptr<Transport> transport, Verify verify, Poll poll);
  ~DeviceTopics() override { services_.withdraw(); }

  /// The driver's thread ends; what comes from ROS afterwards does nothing. False if an output should have
  /// its safe value and has not.
  bool end();

  /// Publishes the status where it is due, and says what diagnostics are to tell next: true if at once. To be
  /// called about ten times a second; it looks closer where there is news, a status is due, or `anyway`.
  bool report(Time now, bool anyway);

  void on_bits(const ReadSpan& span, Span<const std::uint8_t> bits, Time at) override;
  void on_registers(const ReadSpan& span, Span<const std::uint16_t> registers, Time at) override;
  void on_online(bool online) override;
  void on_report(Level level, const std::string& text) override;

 private:
  void refuse(std::optional<std::uint32_t> point, const std::string& what);

  Node& node_;
  Map map_;
  Listeners listeners_;
  std::vector<std::unique_ptr<PointPublisher>> publishers_;  ///< by point; null where it cannot be read
  std::array<std::uint16_t, modbus::max_read_bits> bits_{};  ///< of one span, as publishers take them
  std::function<void(bool)> online_;
  Node::PublishStatus status_;
  Diagnostics diagnostics_;
  DeviceServices services_;
  std::unique_ptr<TracedTransport> transport_;
  DeviceThread thread_;
  std::uint64_t seen_ = 0;  ///< the thread's revision
  Time stale_from_{};       ///< the first of the points that are good
  Time status_due_{};
  WriteHandler writes_;
  LineLimit refused_lines_;
  std::vector<std::shared_ptr<void>> subscriptions_;
};

}  // namespace coupler::host
