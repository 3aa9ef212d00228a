// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros1/topics.hpp"

#include <ros/topic_manager.h>

#include "coupler/host/ros1/in_place_queue.hpp"

namespace coupler::host {

TopicPublisher::TopicPublisher(ros::NodeHandle& handle, ros::AdvertiseOptions options) {
  if (options.latch) {
    subscribed_ = std::make_shared<std::atomic<std::uint32_t>>(0);
    options.connect_cb = [subscribed = subscribed_, next = options.connect_cb](const auto& subscriber) {
      ++*subscribed;
      if (next) next(subscriber);
    };
    options.callback_queue = &InPlaceQueue::instance();
  }
  publisher_ = handle.advertise(options);
}

void TopicPublisher::publish_any(const OutgoingMessage& message) const {
  if (!subscribed_) return publisher_.publish(message);
  // roscpp keeps a message for later subscribers only when it has sent it. Who comes in between gets the one
  // before, and would never know: then the message is sent once more.
  std::uint32_t before = 0;
  do {
    before = *subscribed_;
    publisher_.publish(message);
    // Waits until whoever has just got the one before is counted: roscpp does both under a lock of the topic.
    (void)ros::TopicManager::instance()->isLatched(publisher_.getTopic());
  } while (*subscribed_ != before);
}

}  // namespace coupler::host
