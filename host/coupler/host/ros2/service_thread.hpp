// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "coupler/host/ros/node_templates.hpp"
#include "coupler/host/ros2/rcl/service.hpp"

namespace coupler::host {

struct Ros2Services;

class Ros2ServiceThread : public TypedServiceThread<Ros2ServiceThread, Ros2Services> {
 public:
  explicit Ros2ServiceThread(rcl::Node& node);
  ~Ros2ServiceThread() override;
  Ros2ServiceThread(const Ros2ServiceThread&) = delete;
  Ros2ServiceThread& operator=(const Ros2ServiceThread&) = delete;

  void start() override;
  void stop() override;

  /// Calls function(request, response) in this thread.
  template <class S, class Function>
  void serve(const std::string& name, Function function);

 private:
  void run();

  rcl::Node& node_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> calls_;
  bool stopped_ = false;
  std::vector<std::shared_ptr<void>> services_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace coupler::host
