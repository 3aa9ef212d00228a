// SPDX-License-Identifier: Apache-2.0
// The ROS 2 side of a measurement: listens to bench/p0 … (or NAME/p0 … for each name), or writes
// bench/p0/write ten times a second at times of its own, so that writes fall everywhere between two polls.
//   coupler_bench_driver_listener di|ir|coil|hr COUNT [NAME…]
// prints "matched" when each topic has its other end, and at the end when each message was taken, or was
// about to be published, in µs since 1970: a capture's time stamps are of the same clock.
#include <rcl/rcl.h>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <std_msgs/msg/bool.hpp>
#include <std_msgs/msg/int16.hpp>

#include "test/bench/driver/ros2/session.hpp"

namespace {

using bench::check;
using namespace std::chrono_literals;
using Stamp = std::chrono::system_clock::time_point;

void tell(const std::vector<Stamp>& stamps) {
  for (const Stamp& stamp : stamps)
    std::printf("%.3f\n", std::chrono::duration<double, std::micro>(stamp.time_since_epoch()).count());
}

/// Asks `count_of`, an rcl function, for each topic's other ends.
template <class Topic, class Count>
void wait_for_match(std::deque<Topic>& topics, Count count_of) {
  for (Topic& topic : topics) {
    std::size_t count = 0;
    for (check(count_of(topic, &count)); count == 0 && !bench::ended; check(count_of(topic, &count)))
      std::this_thread::sleep_for(10ms);
  }
  std::puts("matched");
  std::fflush(stdout);
}

/// Subscriptions that have a message, one entry for each message. (A wait set would be filled with 2,048 of
/// them for each wake-up.)
class Arrived {
 public:
  void note(const rcl_subscription_t* subscription) {
    {
      const std::lock_guard lock(mutex_);
      waiting_.push_back(subscription);
    }
    changed_.notify_one();
  }
  /// Null: for half a second there was none.
  const rcl_subscription_t* next() {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_for(lock, 500ms, [this] { return !waiting_.empty(); })) return nullptr;
    const rcl_subscription_t* first = waiting_.front();
    waiting_.pop_front();
    return first;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<const rcl_subscription_t*> waiting_;
};

struct Topic {
  rcl_subscription_t subscription;
  Arrived& arrived;
};

void note(const void* topic, std::size_t messages) {
  const auto* t = static_cast<const Topic*>(topic);
  for (; messages > 0; --messages) t->arrived.note(&t->subscription);
}

template <class M>
void listen(bench::Session& session, int count, const std::vector<std::string>& names) {
  Arrived arrived;
  std::deque<Topic> topics;
  for (const std::string& name : names)
    for (int i = 0; i < count; ++i) {
      Topic& topic =
          topics.emplace_back(Topic{session.subscribe<M>(name + "/p" + std::to_string(i)), arrived});
      check(rcl_subscription_set_on_new_message_callback(&topic.subscription, note, &topic));
    }
  std::thread matching([&] {
    wait_for_match(topics, [](const Topic& topic, std::size_t* publishers) {
      return rcl_subscription_get_publisher_count(&topic.subscription, publishers);
    });
  });
  std::vector<Stamp> stamps;
  M message;
  rmw_message_info_t info;
  while (!bench::ended) {
    const rcl_subscription_t* subscription = arrived.next();
    if (subscription != nullptr && rcl_take(subscription, &message, &info, nullptr) == RCL_RET_OK)
      stamps.push_back(std::chrono::system_clock::now());
  }
  matching.join();
  for (Topic& topic : topics) session.end(topic.subscription);
  tell(stamps);
}

template <class M>
void write(bench::Session& session) {
  std::deque<rcl_publisher_t> topics{session.publish<M>("bench/p0/write")};
  wait_for_match(topics, [](const rcl_publisher_t& topic, std::size_t* subscriptions) {
    return rcl_publisher_get_subscription_count(&topic, subscriptions);
  });
  std::vector<Stamp> stamps;
  M message;
  while (!bench::ended) {
    message.data = static_cast<decltype(message.data)>(1 - message.data);
    stamps.push_back(std::chrono::system_clock::now());
    check(rcl_publish(&topics.front(), &message, nullptr));
    std::this_thread::sleep_for(103ms);
  }
  session.end(topics.front());
  tell(stamps);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const std::string table = argv[1];
  const int count = std::atoi(argv[2]);
  std::vector<std::string> names(argv + 3, argv + argc);
  if (names.empty()) names.emplace_back("bench");
  bench::Session session("bench_listener");
  if (table == "di")
    listen<std_msgs::msg::Bool>(session, count, names);
  else if (table == "ir")
    listen<std_msgs::msg::Int16>(session, count, names);
  else if (table == "coil")
    write<std_msgs::msg::Bool>(session);
  else
    write<std_msgs::msg::Int16>(session);
}
