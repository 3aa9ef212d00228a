// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <ros/callback_queue_interface.h>

namespace coupler::host {

/// Runs a callback where it arises, in ROS's network thread, instead of waking another thread for it: a third
/// of the time from message to Modbus request. The callbacks must not wait for anything.
class InPlaceQueue : public ros::CallbackQueueInterface {
 public:
  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t /*owner*/) override {
    callback->call();
  }
  void removeByID(std::uint64_t /*owner*/) override {}  // nothing is ever kept

  /// It keeps nothing, so that one is enough for all.
  static InPlaceQueue& instance() {
    static InPlaceQueue queue;
    return queue;
  }
};

}  // namespace coupler::host
