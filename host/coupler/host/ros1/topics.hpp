// SPDX-License-Identifier: Apache-2.0
// Topics of many types of messages. For each type, roscpp's own templates take a second to compile; here only
// what depends on the type is a template.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include <ros/message_traits.h>
#include <ros/node_handle.h>
#include <ros/serialization.h>
#include <ros/subscription_callback_helper.h>

namespace coupler::host {

/// A message of whatever type, for ros::Publisher::publish().
struct OutgoingMessage {
  const void* message;
  std::uint32_t (*length)(const void* message);  ///< in bytes, as it is sent
  void (*write)(ros::serialization::OStream& stream, const void* message);
};

/// A ros::Publisher for messages of one type. If the topic is latched, each subscriber has its last message.
class TopicPublisher {
 public:
  TopicPublisher() = default;
  /// Advertises the topic. A latched one's callbacks are called in ROS's network thread.
  TopicPublisher(ros::NodeHandle& handle, ros::AdvertiseOptions options);

  template <class Message>
  void publish(const Message& message) const {
    publish_any({&message,
                 [](const void* of) {
                   return ros::serialization::serializationLength(*static_cast<const Message*>(of));
                 },
                 [](ros::serialization::OStream& stream, const void* of) {
                   ros::serialization::serialize(stream, *static_cast<const Message*>(of));
                 }});
  }

 private:
  void publish_any(const OutgoingMessage& message) const;  // in topics.cpp: once, not inlined for each type

  std::shared_ptr<std::atomic<std::uint32_t>> subscribed_;  ///< how often somebody has; null if not latched
  ros::Publisher publisher_;
};

/// How roscpp makes a message of what it has received, and calls `function(const Message&)`.
template <class Message, class Function>
class TopicReceiver : public ros::SubscriptionCallbackHelper {
 public:
  explicit TopicReceiver(Function function) : function_(std::move(function)) {}

  ros::VoidConstPtr deserialize(const ros::SubscriptionCallbackHelperDeserializeParams& received) override {
    auto message = boost::make_shared<Message>();
    ros::serialization::IStream stream(received.buffer, received.length);
    ros::serialization::deserialize(stream, *message);
    return message;
  }
  void call(ros::SubscriptionCallbackHelperCallParams& received) override {
    function_(*static_cast<const Message*>(received.event.getConstMessage().get()));
  }
  const std::type_info& getTypeInfo() override { return typeid(Message); }
  bool isConst() override { return true; }
  bool hasHeader() override { return ros::message_traits::hasHeader<Message>(); }

 private:
  Function function_;
};

/// Options to subscribe: `function(const Message&)` is called for each message.
template <class Message, class Function>
ros::SubscribeOptions subscribe_options(const std::string& topic, std::uint32_t queue_size,
                                        Function function) {
  ros::SubscribeOptions options(topic, queue_size, ros::message_traits::md5sum<Message>(),
                                ros::message_traits::datatype<Message>());
  options.helper.reset(new TopicReceiver<Message, Function>(std::move(function)));
  return options;
}

}  // namespace coupler::host

namespace ros {

namespace message_traits {
template <>
struct MD5Sum<coupler::host::OutgoingMessage> {
  static const char* value(const coupler::host::OutgoingMessage&) { return "*"; }  // any
};
template <>
struct DataType<coupler::host::OutgoingMessage> {
  static const char* value(const coupler::host::OutgoingMessage&) { return "*"; }
};
}  // namespace message_traits

namespace serialization {
template <>
struct Serializer<coupler::host::OutgoingMessage> {
  static void write(OStream& stream, const coupler::host::OutgoingMessage& message) {
    message.write(stream, message.message);
  }
  static std::uint32_t serializedLength(const coupler::host::OutgoingMessage& message) {
    return message.length(message.message);
  }
};
}  // namespace serialization

}  // namespace ros
