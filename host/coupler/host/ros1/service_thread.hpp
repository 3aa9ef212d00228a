// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <thread>
#include <vector>

#include "coupler/host/ros/typed_service_thread.hpp"

namespace coupler::host {

struct Ros1Services;

class Ros1ServiceThread : public TypedServiceThread<Ros1ServiceThread, Ros1Services> {
 public:
  explicit Ros1ServiceThread(ros::NodeHandle& handle);
  ~Ros1ServiceThread() override;
  Ros1ServiceThread(const Ros1ServiceThread&) = delete;
  Ros1ServiceThread& operator=(const Ros1ServiceThread&) = delete;

  void start() override;
  void end() override { queue_.disable(); }

  /// Calls function(request, response).
  template <class S, class Function>
  void serve(const std::string& name, Function function);

 private:
  ros::NodeHandle& handle_;
  ros::CallbackQueue queue_;
  std::vector<ros::ServiceServer> servers_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace coupler::host
