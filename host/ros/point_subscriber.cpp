// SPDX-License-Identifier: Apache-2.0
#include "host/ros/point_subscriber.hpp"

#include <array>

#include "host/ros/in_place_queue.hpp"
#include "host/ros/message.hpp"

namespace coupler::driver {
namespace {

constexpr std::uint32_t writes_per_value = 10;  ///< as long as one value may wait, so many writes may

}  // namespace

ros::Subscriber subscribe(ros::NodeHandle& handle, const std::string& topic, const Map& map,
                          std::uint32_t index, const WriteHandler& handler) {
  return with_message(map.points[index], [&](auto kind) {
    using Kind = decltype(kind);
    using Message = typename Kind::Message;
    const auto receive = [&handler, &map, topic, index](const boost::shared_ptr<const Message>& message) {
      std::array<std::uint16_t, modbus::max_write_bits> values{};
      const Point& point = map.points[index];
      const std::string wrong = Kind::encode(*message, point, values.data());
      if (wrong.empty())
        handler.accept(make_write(map, index, {values.data(), range(point).count()}));
      else
        handler.refuse(index, topic + ": " + wrong);
    };
    auto options =
        ros::SubscribeOptions::create<Message>(topic, writes_per_value * map.points[index].host.queue_size,
                                               receive, ros::VoidPtr(), InPlaceQueue::instance());
    options.allow_concurrent_callbacks = true;  // never told to try again, which an in-place queue could not
    options.transport_hints = ros::TransportHints().tcpNoDelay();
    return handle.subscribe(options);
  });
}

}  // namespace coupler::driver
