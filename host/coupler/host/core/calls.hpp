// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <future>
#include <mutex>
#include <string>
#include <vector>

namespace coupler::host {

/// Callers in any thread who wait for something that the connection's owner does: reset the coupler's
/// watchdog, write the safe values.
class Calls {
 public:
  struct Answer {
    bool success;
    std::string text;
  };

  /// Answered at once where nobody would do it: there is no connection.
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
  /// All who have asked.
  void answer(const Answer& answer) {
    const std::lock_guard lock(mutex_);
    answer_all(answer);
  }

  /// From now on somebody does it.
  void open() {
    const std::lock_guard lock(mutex_);
    closed_.clear();
  }
  /// Nobody does it: who has asked and who asks is told `why`.
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
