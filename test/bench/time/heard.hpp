// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <ctime>
#include <functional>
#include <limits>
#include <mutex>
#include <string>
#include <thread>

#include "test/bench/node/lock_step_client.hpp"

namespace coupler::bench {

/// ns of a clock such as CLOCK_MONOTONIC.
inline std::int64_t now(clockid_t clock) {
  timespec time{};
  ::clock_gettime(clock, &time);
  return time.tv_sec * std::int64_t{1'000'000'000} + time.tv_nsec;
}

/// What to add to CLOCK_MONOTONIC for CLOCK_REALTIME, true within plus or minus `error`; ns.
struct WallOffset {
  std::int64_t offset = 0;
  std::int64_t error = std::numeric_limits<std::int64_t>::max();
};
inline WallOffset wall_offset() {
  WallOffset best;
  for (int i = 0; i < 10; ++i) {
    const std::int64_t before = now(CLOCK_MONOTONIC);
    const std::int64_t wall = now(CLOCK_REALTIME);
    const std::int64_t half = (now(CLOCK_MONOTONIC) - before + 1) / 2;
    if (half < best.error) best = {wall - before - half, half};
  }
  return best;
}

/// The messages of a topic, and when they came; somebody else spins. What does not come within three minutes
/// ends the program with status 1.
template <class M>
class Heard {
 public:
  Heard(ros::NodeHandle& handle, const std::string& topic) {
    const auto receive = [this](const boost::shared_ptr<const M>& message) {
      const std::int64_t at = now(CLOCK_MONOTONIC);
      const std::lock_guard lock(mutex_);
      last_ = {at, message};
      news_.notify_one();
    };
    subscriber_ =
        handle.subscribe<M>(topic, 100, boost::function<void(const boost::shared_ptr<const M>&)>(receive),
                            ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  }

  /// Until somebody publishes it.
  void connect() const {
    for (int i = 0; subscriber_.getNumPublishers() == 0; ++i) {
      if (i == 6000) give_up("nobody publishes a topic");
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }

  struct Message {
    std::int64_t at = 0;  ///< when it came, CLOCK_MONOTONIC
    boost::shared_ptr<const M> message;
  };
  /// The last one, once it is as wanted.
  Message wait_for(const std::function<bool(const M&)>& is_wanted) {
    std::unique_lock lock(mutex_);
    if (!news_.wait_for(lock, std::chrono::minutes(3),
                        [&] { return last_.message && is_wanted(*last_.message); }))
      give_up("a message did not come");
    return last_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable news_;
  Message last_;
  ros::Subscriber subscriber_;
};

}  // namespace coupler::bench
