// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "coupler/host/core/clock.hpp"

namespace coupler::host {

/// A goal of an action, as long as the node is there.
using GoalNumber = std::uint64_t;
enum class GoalEnd : std::uint8_t { succeeded, aborted, cancelled };

/// The action coupler_driver/WaitFor. The destructor waits for a call of a handler that runs.
class WaitForServer {
 public:
  struct Goal {
    std::string point;
    std::string condition;
    std::string value;
    std::chrono::nanoseconds for_at_least{};
    std::chrono::nanoseconds timeout{};
    std::chrono::nanoseconds since{};  ///< wall time; 0: none
  };
  struct Result {
    bool met = false;
    std::string value;
    std::chrono::nanoseconds stamp{};  ///< wall time; 0: none
    std::chrono::duration<double> uncertainty{};
    std::string reason;
  };
  /// The functions that the server calls in a thread of ROS. They must not wait for anything.
  struct Handler {
    /// `received`: before the goal was accepted, after which its client may act.
    std::function<void(WaitForServer&, GoalNumber, Time received, const Goal&)> begin;
    std::function<void(GoalNumber)> cancel;
  };

  virtual ~WaitForServer() = default;
  /// Gives the result of a goal. Nothing if it has one. Any thread may call it.
  virtual void finish(GoalNumber number, GoalEnd how, const Result& result) = 0;
};

}  // namespace coupler::host
