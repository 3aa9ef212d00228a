// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/service_thread.hpp"

#include <coupler_driver/srv/read.hpp>
#include <coupler_driver/srv/write.hpp>
#include <std_srvs/srv/set_bool.hpp>
#include <std_srvs/srv/trigger.hpp>

#include <utility>

namespace coupler::host {

struct Ros2Services {
  using Write = coupler_driver::srv::Write;
  using Read = coupler_driver::srv::Read;
  using SetBool = std_srvs::srv::SetBool;
  using Trigger = std_srvs::srv::Trigger;
};

Ros2ServiceThread::Ros2ServiceThread(rcl::Node& node) : node_(node) {}

Ros2ServiceThread::~Ros2ServiceThread() {
  Ros2ServiceThread::stop();
  if (thread_.joinable()) thread_.join();
}

void Ros2ServiceThread::start() {
  thread_ = std::thread([this] { run(); });
}

void Ros2ServiceThread::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    calls_.clear();
  }
  changed_.notify_one();
}

void Ros2ServiceThread::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stopped_ || !calls_.empty(); });
    if (stopped_) return;
    const auto call = std::move(calls_.front());
    calls_.pop_front();
    lock.unlock();
    call();
    lock.lock();
  }
}

template <class S, class Function>
void Ros2ServiceThread::serve(const std::string& name, Function function) {
  using Service = rcl::Service<S>;
  auto service = std::make_shared<std::unique_ptr<Service>>();
  *service =
      std::make_unique<Service>(node_, name,
                                [this, function = std::move(function), self = service.get()](
                                    const typename S::Request& request, rcl::AnyService::RequestId id) {
                                  const std::lock_guard lock(mutex_);
                                  if (stopped_) return;
                                  calls_.push_back([function, self, request, id] {
                                    typename S::Response response;
                                    function(request, response);
                                    (*self)->answer(id, response);
                                  });
                                  changed_.notify_one();
                                });
  services_.push_back(std::move(service));
}

}  // namespace coupler::host
