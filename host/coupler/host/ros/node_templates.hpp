// SPDX-License-Identifier: Apache-2.0
// What the nodes of both ROSes are made of: templates over the types of their messages, publishers and
// services.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "coupler/host/core/publish_policy.hpp"
#include "coupler/host/ros/message_time.hpp"
#include "coupler/host/ros/node.hpp"
#include "coupler/host/ros/status.hpp"

namespace coupler::host {

/// Used for a message that has no stamp.
struct NoStamp {
  void see(const Sample&) const {}
  void forget() const {}
  template <class Message>
  void operator()(Message&, const Sample&) const {}
};

/// The part of a point's publisher that does not depend on its message.
class CountingPublisher : public PointPublisher {
 public:
  CountingPublisher(const Point& point, std::uint32_t index, SubscriberCounts& subscribers)
      : point_(point), policy_(point), index_(index), subscribers_(subscribers) {}

  void add_subscriber() {
    policy_.renew();
    subscribers_.add(index_);
  }
  void remove_subscriber() { subscribers_.remove(index_); }

  Time repeat_at() const override { return policy_.repeat_at(); }
  void renew() override { policy_.renew(); }

 protected:
  const Point& point_;
  PublishPolicy policy_;

 private:
  std::uint32_t index_;
  SubscriberCounts& subscribers_;
};

/// Publishes a point as a kind of message (message.hpp), or with Stamper or SampleStamper
/// (stamped_message.hpp).
template <class Kind, class Publisher, class PutStamp = NoStamp>
class TypedPublisher : public CountingPublisher {
 public:
  using Message = typename Kind::Message;

  TypedPublisher(const Point& point, std::uint32_t index, SubscriberCounts& subscribers,
                 const PutStamp& put_stamp = {})
      : CountingPublisher(point, index, subscribers), put_stamp_(put_stamp) {}

  /// Before anything is published. The publisher may call add_subscriber() and remove_subscriber() already.
  void set_publisher(Publisher publisher) { publisher_ = std::move(publisher); }

  void publish(const std::uint16_t* registers, const Sample& sample) override {
    put_stamp_.see(sample);
    if (!policy_.calls_news(registers, sample.stamp.at)) return;
    Kind::decode(registers, point_, message_);
    put_stamp_(message_, sample);
    publisher_.publish(message_);
  }
  void forget() override { put_stamp_.forget(); }

 private:
  PutStamp put_stamp_;
  Message message_;
  Publisher publisher_;
};

/// Hands on a message that came on the topic of `map.points[index]`; Kind: a kind of message (message.hpp).
template <class Kind>
void receive(const typename Kind::Message& message, const std::string& topic, const Map& map,
             std::uint32_t index, const WriteHandler& handler) {
  std::array<std::uint16_t, modbus::max_write_bits> values{};
  const Point& point = map.points[index];
  const std::string wrong = Kind::encode(message, point, values.data());
  if (wrong.empty())
    handler.accept(make_write(map, index, {values.data(), range(point).count()}));
  else
    handler.refuse(index, topic + ": " + wrong);
}

/// A topic of writes keeps ten times as many messages as one of values.
constexpr std::uint32_t writes_per_value = 10;

/// Fills a response of coupler_driver/Write.
template <class Response>
void fill(Response& response, const WriteTicket::Outcome& outcome) {
  using Outcome = WriteResult::Outcome;
  static_assert(outcome_number(Outcome::ok) == Response::OK &&
                outcome_number(Outcome::superseded) == Response::SUPERSEDED &&
                outcome_number(Outcome::exception) == Response::EXCEPTION &&
                outcome_number(Outcome::not_taken) == Response::NOT_TAKEN &&
                outcome_number(Outcome::lost) == Response::LOST &&
                outcome_number(Outcome::dropped) == Response::DROPPED &&
                outcome_number(Outcome::kept) == Response::KEPT &&
                outcome_number(Outcome::refused) == Response::REFUSED);
  response.success = outcome.outcome == Outcome::ok;
  response.outcome = outcome_number(outcome.outcome);
  response.exception = outcome.exception ? static_cast<std::uint8_t>(*outcome.exception) : std::uint8_t{0};
  response.message = outcome.text;
}

/// Fills a response of coupler_driver/Read.
template <class Response>
void fill(Response& response, const ServiceThread::ReadAnswer& answer) {
  response.success = answer.success;
  response.value = answer.value;
  response.message = answer.message;
}

/// Fills a response of coupler_driver/Schedule.
template <class Response>
void fill(Response& response, const ScheduleAnswer& answer) {
  response.success = answer.number != 0;
  response.number = answer.number;
  response.message = answer.text;
}

/// Reads a request of coupler_driver/Schedule.
template <class Request>
ServiceThread::ScheduleRequest schedule_request(const Request& request) {
  return {request.point, request.value, message_time(request.at), message_time(request.how_long)};
}

/// Fills a coupler_driver/ScheduledWrite.
template <class Message>
void fill(Message& message, const ServiceThread::ListedWrite& write) {
  message.number = write.number;
  message.point = write.point;
  message.value = write.value;
  put_time(message.due, write.due);
  put_time(message.how_long, write.how_long);
  message.by_device = write.by_device;
}

/// Fills a coupler_driver/Scheduled, but for the point.
template <class Message>
void fill(Message& message, const ScheduledOutcome& outcome, const WallTime& wall) {
  using Result = ScheduledOutcome::Result;
  static_assert(static_cast<int>(Result::done) == Message::DONE &&
                static_cast<int>(Result::cancelled) == Message::CANCELLED &&
                static_cast<int>(Result::failed) == Message::FAILED &&
                static_cast<int>(Result::unknown) == Message::UNKNOWN);
  put_time(message.header.stamp, wall.of(outcome.at.at));
  message.number = outcome.number;
  message.result = static_cast<std::uint8_t>(outcome.result);
  message.reason = outcome.reason;
  put_time(message.due, outcome.asked);
  message.lateness = std::chrono::duration<double>(outcome.lateness()).count();
  message.uncertainty = std::chrono::duration<double>(outcome.at.uncertainty + wall.error()).count();
}

/// Fills a response of std_srvs/SetBool or std_srvs/Trigger.
template <class Response>
void fill(Response& response, const CallAnswer& answer) {
  response.success = answer.success;
  response.message = answer.text;
}

/// Fills an entry of diagnostic_msgs/DiagnosticArray, but for its name.
template <class Status>
void fill(Status& status, const DiagnosticEntry& entry) {
  status.level = entry.level == Level::info      ? Status::OK
                 : entry.level == Level::warning ? Status::WARN
                                                 : Status::ERROR;
  status.message = entry.message;
  status.hardware_id = entry.hardware_id;
  for (const auto& [key, value] : entry.values) {
    auto& added = status.values.emplace_back();
    added.key = key;
    added.value = value;
  }
}

/// Used by Node::advertise_online(): the publisher is one of std_msgs/Bool.
template <class Message, class Publisher>
std::function<void(bool)> online_with(const Publisher& publisher) {
  return [publisher](bool online) {
    Message message;
    message.data = online;
    publisher.publish(message);
  };
}

/// Used by Node::advertise_status(): the publisher is one of coupler_driver/Status, and `now()` is the time
/// in messages.
template <class Message, class Publisher, class Clock>
Node::PublishStatus status_with(const Publisher& publisher, const Map& map, Clock now) {
  return [publisher, now, status = std::make_shared<Status<Message>>(map)](
             const DeviceSnapshot& device, const std::vector<PointQuality>& points, Time at) {
    if (!status->update(device, points, at)) return false;
    status->message().header.stamp = now();
    publisher.publish(status->message());
    return true;
  };
}

/// Used by Node::advertise_scheduled(): the publisher is one of coupler_driver/Scheduled.
template <class Message, class Publisher>
Node::PublishScheduled scheduled_with(const Publisher& publisher, const Map& map, const WallTime& wall) {
  return [publisher, &map, &wall](const ScheduledOutcome& outcome) {
    Message message;
    fill(message, outcome, wall);
    message.point = std::string(map.points[outcome.point].name);
    publisher.publish(message);
  };
}

/// Used by Node::advertise_tool_state(): the publisher is one of coupler_driver/ToolState.
template <class Message, class Publisher>
Node::PublishToolState tool_state_with(const Publisher& publisher) {
  static_assert(static_cast<int>(ToolState::unknown) == Message::UNKNOWN &&
                static_cast<int>(ToolState::opening) == Message::OPENING &&
                static_cast<int>(ToolState::open) == Message::OPEN &&
                static_cast<int>(ToolState::closing) == Message::CLOSING &&
                static_cast<int>(ToolState::closed) == Message::CLOSED &&
                static_cast<int>(ToolState::holding) == Message::HOLDING &&
                static_cast<int>(ToolState::stuck) == Message::STUCK &&
                static_cast<int>(ToolState::contradictory) == Message::CONTRADICTORY);
  return [publisher](const ToolStatus& status, std::chrono::nanoseconds since) {
    Message message;
    message.state = static_cast<std::uint8_t>(status.state);
    put_time(message.since, since);
    message.reason = status.reason;
    publisher.publish(message);
  };
}

/// Used by Node::advertise_joints(): the publisher is one of sensor_msgs/JointState.
template <class Message, class Publisher>
Node::PublishJoints joints_with(const Publisher& publisher) {
  return [publisher, message = Message()](Span<const Node::Joint> joints,
                                          std::chrono::nanoseconds stamp) mutable {
    put_time(message.header.stamp, stamp);
    message.name.resize(joints.size());
    message.position.resize(joints.size());
    for (std::size_t i = 0; i < joints.size(); ++i) {
      message.name[i] = joints[i].name;
      message.position[i] = joints[i].position;
    }
    publisher.publish(message);
  };
}

/// Types names the service types of a ROS; `Adapter::serve<S>(name, function)` offers a service that calls
/// function(request, response) in the adapter's thread.
template <class Adapter, class Types>
class TypedServiceThread : public ServiceThread {
 public:
  void offer_write(
      const std::string& name,
      std::function<WriteTicket::Outcome(const std::string&, const std::string&)> call) override {
    serve<typename Types::Write>(name, [call = std::move(call)](const auto& request, auto& response) {
      fill(response, call(request.point, request.value));
    });
  }
  void offer_schedule(const std::string& name,
                      std::function<ScheduleAnswer(const ServiceThread::ScheduleRequest&)> call) override {
    serve<typename Types::Schedule>(name, [call = std::move(call)](const auto& request, auto& response) {
      fill(response, call(schedule_request(request)));
    });
  }
  void offer_cancel(const std::string& name, std::function<CallAnswer(std::uint32_t)> call) override {
    serve<typename Types::CancelScheduled>(name,
                                           [call = std::move(call)](const auto& request, auto& response) {
                                             fill(response, call(request.number));
                                           });
  }
  void offer_list(const std::string& name, std::function<std::vector<ListedWrite>()> call) override {
    serve<typename Types::ListScheduled>(name, [call = std::move(call)](const auto&, auto& response) {
      for (const ListedWrite& write : call()) fill(response.writes.emplace_back(), write);
    });
  }
  void offer_read(const std::string& name, std::function<ReadAnswer(const std::string&)> call) override {
    serve<typename Types::Read>(name, [call = std::move(call)](const auto& request, auto& response) {
      fill(response, call(request.point));
    });
  }
  void offer_set(const std::string& name, std::function<CallAnswer(bool)> call) override {
    serve<typename Types::SetBool>(name, [call = std::move(call)](const auto& request, auto& response) {
      fill(response, call(request.data != 0));
    });
  }
  void offer_trigger(const std::string& name, std::function<CallAnswer()> call) override {
    serve<typename Types::Trigger>(
        name, [call = std::move(call)](const auto&, auto& response) { fill(response, call()); });
  }

 private:
  friend Adapter;
  TypedServiceThread() = default;

  template <class S, class Function>
  void serve(const std::string& name, Function function) {
    static_cast<Adapter&>(*this).template serve<S>(name, std::move(function));
  }
};

}  // namespace coupler::host
