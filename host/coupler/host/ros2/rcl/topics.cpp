// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/rcl/topics.hpp"

#include <rcl/event.h>
#include <rcl/subscription.h>
#include <rmw/incompatible_qos_events_statuses.h>
#include <rmw/qos_string_conversions.h>

#include <optional>

#include "coupler/host/ros2/rcl/distro.hpp"

namespace coupler::rcl {
namespace {

/// Calls `handle` for an event of a publisher or a subscription, with the middleware's Status, as long as the
/// result exists; with a middleware that does not support it, never. `entity`: an rcl_publisher_t or
/// rcl_subscription_t, which must outlive it; `init`: rcl's function for it.
template <class Status, class Entity, class Type>
std::shared_ptr<void> follow(Inbox& inbox, const Entity& entity, Type type,
                             rcl_ret_t (*init)(rcl_event_t*, const Entity*, Type),
                             std::function<void(const Status&)> handle) {
  struct Event {
    Handle<rcl_event_t> handle{rcl_get_zero_initialized_event(), rcl_event_fini};
    std::optional<Inbox::Source> source;  // last: it uses the other
  };
  const std::string failure = "cannot receive the events of a topic";
  const auto result = std::make_shared<Event>();
  rcl_event_t* const event = result->handle.get();
  const rcl_ret_t made = init(event, &entity, type);
  if (made == RCL_RET_UNSUPPORTED) {
    take_error_text();
    return nullptr;
  }
  check(made, failure);
  const auto take = [event, handle = std::move(handle)] {
    Status status{};  // NOLINT(bugprone-invalid-enum-default-initialization): rcl fills it
    if (rcl_take_event(event, &status) == RCL_RET_OK)
      handle(status);
    else
      take_error_text();
    return false;  // one status holds all that has happened
  };
  result->source.emplace(inbox, event, rcl_event_set_callback, take, failure);
  return result;
}

/// Null if nobody is to be told.
template <class Entity, class Type>
std::shared_ptr<void> report_incompatible(Inbox& inbox, const Entity& entity, Type type,
                                          rcl_ret_t (*init)(rcl_event_t*, const Entity*, Type),
                                          const char* (*topic_of)(const Entity*), OnIncompatible report) {
  using Status = rmw_qos_incompatible_event_status_t;
  if (!report) return nullptr;
  return follow<Status>(inbox, entity, type, init,
                        [&entity, topic_of, report = std::move(report)](const Status& status) {
                          const char* const policy = rmw_qos_policy_kind_to_str(status.last_policy_kind);
                          report(topic_of(&entity), policy != nullptr ? policy : "QoS");
                        });
}

/// Calls `matched` as subscriptions of the publisher come and go.
std::shared_ptr<void> follow_subscriptions(Inbox& inbox, const rcl_publisher_t& publisher,
                                           std::function<void(bool came)> matched) {
  if (!matched) return nullptr;
#if COUPLER_RCL_HAS_MATCHED_EVENTS
  using Status = rmw_matched_status_t;
  return follow<Status>(inbox, publisher, RCL_PUBLISHER_MATCHED, rcl_publisher_event_init,
                        [matched = std::move(matched), before = 0](const Status& status) mutable {
                          const int now = static_cast<int>(status.current_count);
                          // Those that have come and gone meanwhile are counted in both.
                          const int came = static_cast<int>(status.total_count_change);
                          const int gone = before + came - now;
                          before = now;
                          for (int i = 0; i < came; ++i) matched(true);
                          for (int i = 0; i < gone; ++i) matched(false);
                        });
#else
  // Without the events nobody knows when a subscription goes: every point counts as subscribed.
  matched(true);
  return nullptr;
#endif
}

}  // namespace

AnyPublisher::AnyPublisher(Node& node, const rosidl_message_type_support_t* type, const std::string& topic,
                           const rmw_qos_profile_t& qos, PublisherEvents events)
    : node_(node), publisher_(rcl_get_zero_initialized_publisher(), [&node](rcl_publisher_t* publisher) {
        return rcl_publisher_fini(publisher, node.get());
      }) {
  rcl_publisher_options_t options = rcl_publisher_get_default_options();
  options.qos = qos;
  check(rcl_publisher_init(publisher_.get(), node.get(), type, topic.c_str(), &options),
        "cannot publish the topic " + topic);
  events_ = {report_incompatible(node.inbox(), *publisher_.get(), RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS,
                                 rcl_publisher_event_init, rcl_publisher_get_topic_name,
                                 std::move(events.incompatible)),
             follow_subscriptions(node.inbox(), *publisher_.get(), std::move(events.matched))};
}

void AnyPublisher::publish(const void* message) {
  if (rcl_publish(publisher_.get(), message, nullptr) != RCL_RET_OK)
    node_.log_failure("cannot publish " + topic());
}

std::shared_ptr<void> subscribe_any(Node& node, const rosidl_message_type_support_t* type,
                                    const std::string& topic, const rmw_qos_profile_t& qos, Receiver receiver,
                                    OnIncompatible incompatible) {
  struct Subscription {
    Handle<rcl_subscription_t> handle;
    std::shared_ptr<void> incompatible{};
    std::optional<Inbox::Source> source{};  // last: it uses the others
  };
  const std::string failure = "cannot subscribe to the topic " + topic;
  const auto result = std::shared_ptr<Subscription>(
      new Subscription{{rcl_get_zero_initialized_subscription(), [&node](auto* subscription) {
                          return rcl_subscription_fini(subscription, node.get());
                        }}});
  rcl_subscription_t* const subscription = result->handle.get();
  rcl_subscription_options_t options = rcl_subscription_get_default_options();
  options.qos = qos;
  check(rcl_subscription_init(subscription, node.get(), type, topic.c_str(), &options), failure);
  ignore(rcl_subscription_options_fini(&options));
  result->incompatible = report_incompatible(
      node.inbox(), *subscription, RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS, rcl_subscription_event_init,
      rcl_subscription_get_topic_name, std::move(incompatible));
  const auto take = [&node, subscription, receiver = std::move(receiver)] {
    rmw_message_info_t ignored;
    const bool taken = node.has_taken(rcl_take(subscription, receiver.message, &ignored, nullptr),
                                      RCL_RET_SUBSCRIPTION_TAKE_FAILED, "cannot read a message of ",
                                      rcl_subscription_get_topic_name(subscription));
    if (taken) receiver.receive();
    return taken;
  };
  result->source.emplace(node.inbox(), subscription, rcl_subscription_set_on_new_message_callback, take,
                         failure);
  return result;
}

}  // namespace coupler::rcl
