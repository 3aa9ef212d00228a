// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <future>
#include <mutex>
#include <string>
#include <vector>

namespace coupler::host {

/// Calls from any thread that the connection's owner carries out: to reset the coupler's watchdog, to write
/// the safe values.
class Calls {
 public:
  struct Answer {
    bool success;
    std::string text;
  };

  /// Answered at once if there is no connection.
  std::future<Answer> ask() {
    const std::lock_guard lock(mutex_);
    std::promise<Answer> asked;
    auto answer = asked.get_future();
    if (closed_.empty()) {
      asked_.push_back(std::move(asked));
      any_ = true;
    } else {
      asked.set_value({false, closed_});
    }
    return answer;
  }
  bool any() const { return any_; }
  /// Answers all calls that wait.
  void answer(const Answer& answer) {
    const std::lock_guard lock(mutex_);
    answer_all(answer);
  }

  /// There is a connection.
  void open() {
    const std::lock_guard lock(mutex_);
    closed_.clear();
  }
  /// There is no connection: calls that wait, and new ones, are answered with `why`.
  void close(const std::string& why) {
    const std::lock_guard lock(mutex_);
    closed_ = why;
    answer_all({false, why});
  }

 private:
  void answer_all(const Answer& answer) {
    for (auto& asked : asked_) asked.set_value(answer);
    asked_.clear();
    any_ = false;
  }

  std::mutex mutex_;
  std::string closed_ = "not connected";  ///< why; empty while open
  std::vector<std::promise<Answer>> asked_;
  std::atomic<bool> any_{false};  ///< asked_ is not empty
};

}  // namespace coupler::host
