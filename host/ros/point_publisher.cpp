// SPDX-License-Identifier: Apache-2.0
#include "host/ros/point_publisher.hpp"

#include "host/ros/message.hpp"

namespace coupler::driver {
namespace {

constexpr std::uint32_t queue_size = 10;

template <class Kind>
class TypedPublisher : public PointPublisher {
 public:
  TypedPublisher(ros::NodeHandle& handle, const std::string& topic, const codec::Format& format)
      : format_(format), publisher_(handle.advertise<typename Kind::Message>(topic, queue_size)) {}

  void publish(const std::uint16_t* registers) override {
    Kind::decode(registers, format_, message_);
    publisher_.publish(message_);
  }

 private:
  codec::Format format_;
  typename Kind::Message message_;
  ros::Publisher publisher_;
};

}  // namespace

std::unique_ptr<PointPublisher> advertise(ros::NodeHandle& handle, const std::string& topic,
                                          const Point& point) {
  return with_message(point, [&](auto kind) -> std::unique_ptr<PointPublisher> {
    return std::make_unique<TypedPublisher<decltype(kind)>>(handle, topic, point.format);
  });
}

}  // namespace coupler::driver
