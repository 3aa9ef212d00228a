// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace coupler::rcl {

/// What the middleware has for this program: messages, requests, events. The middleware's threads only note
/// that there is something; the inbox has one thread that takes it. (A wait set would have to be filled with
/// each of some thousand entities at each wake-up.)
class Inbox {
 public:
  /// What the inbox takes from.
  class Source {
   public:
    explicit Source(Inbox& inbox) : inbox_(inbox) {}
    Source(const Source&) = delete;
    Source& operator=(const Source&) = delete;

    /// There is something. Any thread may call.
    void note() {
      if (!noted_.exchange(true)) inbox_.add(*this);
    }

   protected:
    /// note() as a callback of rcl, whose argument must be self().
    static void note_of(const void* self, std::size_t /*how_many*/) {
      const_cast<Source*>(static_cast<const Source*>(self))->note();
    }
    const void* self() const { return static_cast<const Source*>(this); }
    /// After leave().
    virtual ~Source() = default;
    /// For the destructor of a derived class: take() does not run, and is not called any more.
    void leave() { inbox_.remove(*this); }
    /// Takes one thing, in the inbox's thread; false: there is nothing.
    virtual bool take() = 0;

   private:
    friend class Inbox;
    Inbox& inbox_;
    std::atomic<bool> noted_{false};
    bool left_ = false;  ///< leave() was called
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
  const Source* current_ = nullptr;  ///< its take() runs
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace coupler::rcl
