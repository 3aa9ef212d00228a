// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <thread>
#include <vector>

#include "host/ros/node.hpp"

namespace coupler::driver {

class Ros1ServiceThread : public ServiceThread {
 public:
  explicit Ros1ServiceThread(ros::NodeHandle& handle) : handle_(handle) {}
  ~Ros1ServiceThread() override;
  Ros1ServiceThread(const Ros1ServiceThread&) = delete;
  Ros1ServiceThread& operator=(const Ros1ServiceThread&) = delete;

  void offer_write(const std::string& name,
                   std::function<WriteTicket::Outcome(const std::string&, const std::string&)> call) override;
  void offer_read(const std::string& name, std::function<ReadAnswer(const std::string&)> call) override;
  void offer_set(const std::string& name, std::function<Calls::Answer(bool)> call) override;
  void offer_trigger(const std::string& name, std::function<Calls::Answer()> call) override;
  void start() override;
  void end() override { queue_.disable(); }

 private:
  /// Calls function(request, response).
  template <class S, class Function>
  void advertise(const std::string& name, Function function);

  ros::NodeHandle& handle_;
  ros::CallbackQueue queue_;
  std::vector<ros::ServiceServer> servers_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace coupler::driver
