// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "host/ros/node.hpp"
#include "host/ros2/rcl/service.hpp"

namespace coupler::driver {

class Ros2ServiceThread : public ServiceThread {
 public:
  explicit Ros2ServiceThread(rcl::Node& node) : node_(node) {}
  ~Ros2ServiceThread() override;
  Ros2ServiceThread(const Ros2ServiceThread&) = delete;
  Ros2ServiceThread& operator=(const Ros2ServiceThread&) = delete;

  void offer_write(const std::string& name,
                   std::function<WriteTicket::Outcome(const std::string&, const std::string&)> call) override;
  void offer_read(const std::string& name, std::function<ReadAnswer(const std::string&)> call) override;
  void offer_set(const std::string& name, std::function<Calls::Answer(bool)> call) override;
  void offer_trigger(const std::string& name, std::function<Calls::Answer()> call) override;
  void start() override;
  void end() override;

 private:
  /// Calls function(request, response) in this thread.
  template <class S, class Function>
  void offer(const std::string& name, Function function);
  void run();

  rcl::Node& node_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> calls_;
  bool ended_ = false;
  std::vector<std::shared_ptr<void>> services_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace coupler::driver
