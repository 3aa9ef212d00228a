// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <deque>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace coupler::host {

/// Calls from any thread that the connection's owner carries out: `What` is asked for. `Answer{{}, why}`
/// says why not.
template <class What, class TheAnswer>
class CallQueue {
 public:
  using Answer = TheAnswer;
  struct Call {
    What what;
    std::promise<Answer> answer;
  };

  /// Answered at once if there is no connection.
  std::future<Answer> ask(const What& what = {}) {
    const std::lock_guard lock(mutex_);
    Call call{what, {}};
    auto answer = call.answer.get_future();
    if (closed_.empty()) {
      waiting_.push_back(std::move(call));
      any_ = true;
    } else {
      call.answer.set_value({{}, closed_});
    }
    return answer;
  }
  bool any() const { return any_; }
  /// A call waits of which `which(what)` is true.
  template <class Which>
  bool any_of(Which which) {
    if (!any_) return false;
    const std::lock_guard lock(mutex_);
    return find(which) != waiting_.end();
  }
  /// The oldest of them, for the caller to answer; nullopt: none waits.
  template <class Which>
  std::optional<Call> take_one_of(Which which) {
    const std::lock_guard lock(mutex_);
    const auto found = find(which);
    if (found == waiting_.end()) return std::nullopt;
    std::optional<Call> call(std::move(*found));
    waiting_.erase(found);
    any_ = !waiting_.empty();
    return call;
  }
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
    answer_all({{}, why});
  }

 private:
  template <class Which>
  typename std::deque<Call>::iterator find(Which which) {
    return std::find_if(waiting_.begin(), waiting_.end(), [&](const Call& call) { return which(call.what); });
  }
  void answer_all(const Answer& answer) {
    for (Call& call : waiting_) call.answer.set_value(answer);
    waiting_.clear();
    any_ = false;
  }

  std::mutex mutex_;
  std::string closed_ = "not connected";  ///< why; empty while open
  std::deque<Call> waiting_;
  std::atomic<bool> any_{false};  ///< waiting_ is not empty
};

struct CallAnswer {
  bool success;
  std::string text;
};

/// To reset the coupler's watchdog, to write the safe values.
using Calls = CallQueue<std::monostate, CallAnswer>;

}  // namespace coupler::host
