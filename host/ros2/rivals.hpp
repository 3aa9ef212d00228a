// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "host/ros2/rcl/node.hpp"

namespace coupler::driver {

/// Looks for other nodes that publish `<name>/online`, as this one does: two drivers of one device, or of one
/// name. In a thread of its own, since a middleware may take its time to say.
class Rivals {
 public:
  Rivals(rcl::Node& node, std::function<void(const std::string&)> warn)
      : node_(node), warn_(std::move(warn)) {}
  ~Rivals() { end(); }
  Rivals(const Rivals&) = delete;
  Rivals& operator=(const Rivals&) = delete;

  /// Before begin(): a topic of this node, with its namespace.
  void watch(const std::string& online) { topics_.push_back(online); }
  void begin();
  void end();

 private:
  void look();

  rcl::Node& node_;
  std::function<void(const std::string&)> warn_;
  std::vector<std::string> topics_;
  std::set<std::string> warned_of_;
  std::mutex mutex_;
  std::condition_variable ends_;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace coupler::driver
