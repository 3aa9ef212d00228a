// SPDX-License-Identifier: Apache-2.0
#include "host/ros1/service_thread.hpp"

#include <coupler_driver/Read.h>
#include <coupler_driver/Write.h>
#include <ros/advertise_service_options.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <utility>

#include "host/ros/service_reply.hpp"

namespace coupler::driver {
namespace {

/// As long as nothing calls; a call is answered at once.
ros::WallDuration idle_turn() { return ros::WallDuration(1); }

}  // namespace

Ros1ServiceThread::~Ros1ServiceThread() {
  queue_.disable();
  if (thread_.joinable()) thread_.join();
}

template <class S, class Function>
void Ros1ServiceThread::advertise(const std::string& name, Function function) {
  auto options = ros::AdvertiseServiceOptions::create<S>(
      name,
      [function = std::move(function)](typename S::Request& request, typename S::Response& response) {
        function(request, response);
        return true;
      },
      ros::VoidPtr(), &queue_);
  servers_.push_back(handle_.advertiseService(options));
}

void Ros1ServiceThread::offer_write(
    const std::string& name,
    std::function<WriteTicket::Outcome(const std::string&, const std::string&)> call) {
  advertise<coupler_driver::Write>(name, [call = std::move(call)](const auto& request, auto& response) {
    fill(response, call(request.point, request.value));
  });
}

void Ros1ServiceThread::offer_read(const std::string& name,
                                   std::function<ReadAnswer(const std::string&)> call) {
  advertise<coupler_driver::Read>(name, [call = std::move(call)](const auto& request, auto& response) {
    fill(response, call(request.point));
  });
}

void Ros1ServiceThread::offer_set(const std::string& name, std::function<Calls::Answer(bool)> call) {
  advertise<std_srvs::SetBool>(name, [call = std::move(call)](const auto& request, auto& response) {
    fill(response, call(request.data != 0));
  });
}

void Ros1ServiceThread::offer_trigger(const std::string& name, std::function<Calls::Answer()> call) {
  advertise<std_srvs::Trigger>(
      name, [call = std::move(call)](const auto&, auto& response) { fill(response, call()); });
}

void Ros1ServiceThread::start() {
  thread_ = std::thread([this] {
    while (queue_.isEnabled()) queue_.callOne(idle_turn());
  });
}

}  // namespace coupler::driver
