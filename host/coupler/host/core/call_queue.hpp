// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace coupler::host {

/// Gives a call its answer, once.
template <class Answer>
class Reply {
 public:
  using Give = std::function<void(const Answer&)>;
  explicit Reply(Give give) : give_(std::move(give)) {}

  void set_value(const Answer& answer) { std::exchange(give_, nullptr)(answer); }
  bool is_given() const { return give_ == nullptr; }

 private:
  Give give_;
};

/// Calls that any thread makes and the connection's owner carries out. `What` says what is asked for.
/// `Answer{{}, why}` refuses a call.
template <class What, class TheAnswer>
class CallQueue {
 public:
  using Answer = TheAnswer;
  struct Call {
    What what;
    Reply<Answer> answer;
  };

  /// Makes a call. It is answered at once if there is no connection. `give` is called exactly once, perhaps
  /// before ask() returns; it must not call the queue, nor wait for anything.
  void ask(const What& what, typename Reply<Answer>::Give give) {
    const std::lock_guard lock(mutex_);
    Call call{what, Reply<Answer>(std::move(give))};
    if (closed_.empty()) {
      waiting_.push_back(std::move(call));
      any_ = true;
    } else {
      call.answer.set_value({{}, closed_});
    }
  }
  /// The same with a future.
  std::future<Answer> ask(const What& what = {}) {
    const auto promise = std::make_shared<std::promise<Answer>>();
    ask(what, [promise](const Answer& answer) { promise->set_value(answer); });
    return promise->get_future();
  }
  bool any() const { return any_; }
  /// Returns whether a call waits for which `which(what)` is true.
  template <class Which>
  bool any_of(Which which) {
    if (!any_) return false;
    const std::lock_guard lock(mutex_);
    return find(which) != waiting_.end();
  }
  /// Takes the oldest of them, which the caller has to answer; nullopt if none waits.
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
  /// Returns how many calls wait.
  std::size_t size() {
    const std::lock_guard lock(mutex_);
    return waiting_.size();
  }
  /// Answers the `count` oldest calls. Those that came while these were carried out still wait.
  void answer(std::size_t count, const Answer& answer) {
    const std::lock_guard lock(mutex_);
    answer_oldest(count, answer);
  }

  /// Allows calls, because there is a connection.
  void open() {
    const std::lock_guard lock(mutex_);
    closed_.clear();
  }
  /// Answers the calls that wait, and all new ones, with `why`, because the connection has ended.
  void close(const std::string& why) {
    const std::lock_guard lock(mutex_);
    closed_ = why;
    answer_oldest(waiting_.size(), {{}, why});
  }

 private:
  template <class Which>
  typename std::deque<Call>::iterator find(Which which) {
    return std::find_if(waiting_.begin(), waiting_.end(), [&](const Call& call) { return which(call.what); });
  }
  void answer_oldest(std::size_t count, const Answer& answer) {
    for (; count > 0; --count) {
      waiting_.front().answer.set_value(answer);
      waiting_.pop_front();
    }
    any_ = !waiting_.empty();
  }

  std::mutex mutex_;
  std::string closed_ = "not connected";  ///< the reason; empty while there is a connection
  std::deque<Call> waiting_;
  std::atomic<bool> any_{false};  ///< waiting_ is not empty
};

struct CallAnswer {
  bool success;
  std::string text;
};

/// Calls that reset the coupler's watchdog, or write the safe values.
using Calls = CallQueue<std::monostate, CallAnswer>;

}  // namespace coupler::host
