// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rcl/event_callback.h>
#include <rcl/types.h>

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

namespace coupler::rcl {

/// The inbox of what the middleware has for this program: messages, requests, events. The middleware's
/// threads only note that there is something, and the inbox has one thread that takes it. (A wait set would
/// have to be filled with each of some thousand entities at each wake-up.)
class Inbox {
 public:
  /// A source from which the inbox takes as long as it exists.
  class Source {
   public:
    /// `set_callback`: rcl's function for it. `take` takes one thing, in the inbox's thread; false: there is
    /// nothing. Throws Error.
    template <class Entity>
    Source(Inbox& inbox, const Entity* entity,
           rcl_ret_t (*set_callback)(const Entity*, rcl_event_callback_t, const void*),
           std::function<bool()> take, const std::string& failure)
        : inbox_(inbox),
          follow_([=](auto... callback) { return set_callback(entity, callback...); }),
          take_(std::move(take)) {
      begin(failure);
    }
    /// `take` does not run then, and is not called any more.
    ~Source();
    Source(const Source&) = delete;
    Source& operator=(const Source&) = delete;

   private:
    friend class Inbox;
    void begin(const std::string& failure);
    /// There is something. Any thread may call.
    void note() {
      if (!noted_.exchange(true)) inbox_.add(*this);
    }

    Inbox& inbox_;
    std::function<rcl_ret_t(rcl_event_callback_t, const void*)> follow_;
    std::function<bool()> take_;
    std::atomic<bool> noted_{false};
    bool left_ = false;  ///< it is being destroyed
  };

  ~Inbox() { stop(); }
  void start() {
    thread_ = std::thread([this] { run(); });
  }
  /// Takes nothing any more.
  void stop();

 private:
  void add(Source& source);
  void remove(Source& source);
  void run();
  void empty(Source& source);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Source*> noted_;
  const Source* current_ = nullptr;  ///< its `take` runs
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace coupler::rcl
