// SPDX-License-Identifier: Apache-2.0
#include "host/ros/point_publisher.hpp"

#include "host/core/publish_policy.hpp"
#include "host/ros/in_place_queue.hpp"
#include "host/ros/message.hpp"

namespace coupler::driver {
namespace {

template <class Kind>
class TypedPublisher : public PointPublisher {
 public:
  TypedPublisher(ros::NodeHandle& handle, const std::string& topic, const Point& point, std::uint32_t index,
                 Listeners& listeners)
      : point_(point), policy_(point) {
    const auto came = [this, index, &listeners](const ros::SingleSubscriberPublisher&) {
      policy_.renew();
      listeners.came(index);
    };
    const auto left = [index, &listeners](const ros::SingleSubscriberPublisher&) { listeners.left(index); };
    auto options = ros::AdvertiseOptions::create<typename Kind::Message>(
        topic, point.host.queue_size, came, left, ros::VoidPtr(), InPlaceQueue::instance());
    options.latch = point.host.latch;
    publisher_ = handle.advertise(options);
  }

  void publish(const std::uint16_t* registers, Time at) override {
    if (!policy_.calls_news(registers, at)) return;
    Kind::decode(registers, point_, message_);
    publisher_.publish(message_);
  }

  void renew() override { policy_.renew(); }

 private:
  const Point& point_;
  PublishPolicy policy_;
  typename Kind::Message message_;
  ros::Publisher publisher_;
};

}  // namespace

std::unique_ptr<PointPublisher> advertise(ros::NodeHandle& handle, const std::string& topic, const Map& map,
                                          std::uint32_t index, Listeners& listeners) {
  const Point& point = map.points[index];
  return with_message(point, [&](auto kind) -> std::unique_ptr<PointPublisher> {
    return std::make_unique<TypedPublisher<decltype(kind)>>(handle, topic, point, index, listeners);
  });
}

}  // namespace coupler::driver
