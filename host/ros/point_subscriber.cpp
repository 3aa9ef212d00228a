// SPDX-License-Identifier: Apache-2.0
#include "host/ros/point_subscriber.hpp"

#include "host/ros/in_place_queue.hpp"
#include "host/ros/message.hpp"

namespace coupler::driver {
namespace {

constexpr std::uint32_t queue_size = 100;

InPlaceQueue& in_place_queue() {
  static InPlaceQueue queue;
  return queue;
}

}  // namespace

ros::Subscriber subscribe(ros::NodeHandle& handle, const std::string& topic, const Map& map,
                          std::uint32_t index, const WriteHandler& handler) {
  return with_message(map.points[index], [&](auto kind) {
    using Kind = decltype(kind);
    using Message = typename Kind::Message;
    const auto receive = [&handler, topic, index, format = map.points[index].format](
                             const boost::shared_ptr<const Message>& message) {
      Write write;
      write.point = index;
      const std::string wrong = Kind::encode(*message, format, write.registers.data());
      if (wrong.empty())
        handler.accept(write);
      else
        handler.refuse(topic + ": " + wrong);
    };
    auto options =
        ros::SubscribeOptions::create<Message>(topic, queue_size, receive, ros::VoidPtr(), &in_place_queue());
    options.allow_concurrent_callbacks = true;  // never told to try again, which an in-place queue could not
    options.transport_hints = ros::TransportHints().tcpNoDelay();
    return handle.subscribe(options);
  });
}

}  // namespace coupler::driver
