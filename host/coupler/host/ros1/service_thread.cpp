// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros1/service_thread.hpp"

#include <coupler_driver/Read.h>
#include <coupler_driver/Write.h>
#include <ros/advertise_service_options.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <utility>

namespace coupler::host {
namespace {

/// As long as nothing calls; a call is answered at once.
ros::WallDuration idle_turn() { return ros::WallDuration(1); }

}  // namespace

struct Ros1Services {
  using Write = coupler_driver::Write;
  using Read = coupler_driver::Read;
  using SetBool = std_srvs::SetBool;
  using Trigger = std_srvs::Trigger;
};

Ros1ServiceThread::Ros1ServiceThread(ros::NodeHandle& handle) : handle_(handle) {}

Ros1ServiceThread::~Ros1ServiceThread() {
  queue_.disable();
  if (thread_.joinable()) thread_.join();
}

template <class S, class Function>
void Ros1ServiceThread::serve(const std::string& name, Function function) {
  auto options = ros::AdvertiseServiceOptions::create<S>(
      name,
      [function = std::move(function)](typename S::Request& request, typename S::Response& response) {
        function(request, response);
        return true;
      },
      ros::VoidPtr(), &queue_);
  servers_.push_back(handle_.advertiseService(options));
}

void Ros1ServiceThread::start() {
  thread_ = std::thread([this] {
    while (queue_.isEnabled()) queue_.callOne(idle_turn());
  });
}

}  // namespace coupler::host
