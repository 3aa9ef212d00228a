// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "coupler/host/core/publish_policy.hpp"
#include "coupler/host/ros/node.hpp"

namespace coupler::host {

/// Publishes a point as a kind of message (message.hpp), with a publisher of either ROS.
template <class Kind, class Publisher>
class TypedPublisher : public PointPublisher {
 public:
  TypedPublisher(const Point& point, std::uint32_t index, Listeners& listeners)
      : point_(point), policy_(point), index_(index), listeners_(listeners) {}

  /// Before anything is published. It may call came() and left() from now on.
  void use(Publisher publisher) { publisher_ = std::move(publisher); }

  void came() {
    policy_.renew();
    listeners_.came(index_);
  }
  void left() { listeners_.left(index_); }

  void publish(const std::uint16_t* registers, Time at) override {
    if (!policy_.calls_news(registers, at)) return;
    Kind::decode(registers, point_, message_);
    publisher_.publish(message_);
  }

  void renew() override { policy_.renew(); }

 private:
  const Point& point_;
  PublishPolicy policy_;
  std::uint32_t index_;
  Listeners& listeners_;
  typename Kind::Message message_;
  Publisher publisher_;
};

}  // namespace coupler::host
