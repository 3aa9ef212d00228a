// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/advertise_service_options.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <string>
#include <thread>
#include <vector>

namespace coupler::driver {

/// Answers services in a thread of its own, one call after the other: each may wait for its result.
class ServiceThread {
 public:
  ServiceThread() = default;
  /// Waits for the call in progress.
  ~ServiceThread() {
    end();
    if (thread_.joinable()) thread_.join();
  }
  ServiceThread(const ServiceThread&) = delete;
  ServiceThread& operator=(const ServiceThread&) = delete;

  /// Calls function(request, response). Before start().
  template <class S, class Function>
  void advertise(ros::NodeHandle& handle, const std::string& name, Function function) {
    auto options = ros::AdvertiseServiceOptions::create<S>(
        name,
        [function](typename S::Request& request, typename S::Response& response) {
          function(request, response);
          return true;
        },
        ros::VoidPtr(), &queue_);
    servers_.push_back(handle.advertiseService(options));
  }
  void start() {
    thread_ = std::thread([this] {
      while (queue_.isEnabled()) queue_.callOne(idle_turn());
    });
  }
  /// Takes no more calls.
  void end() { queue_.disable(); }

 private:
  /// As long as nothing calls; a call is answered at once.
  static ros::WallDuration idle_turn() { return ros::WallDuration(1); }

  ros::CallbackQueue queue_;
  std::vector<ros::ServiceServer> servers_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace coupler::driver
