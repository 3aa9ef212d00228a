// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/epoll.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>

#include "coupler/base/descriptor.hpp"
#include "coupler/device/core/time.hpp"

namespace coupler::device {

/// The function that is called when a descriptor is ready. It is called again as long as the descriptor stays
/// ready, and may be called without reason, so it may only make non-blocking calls.
class EventHandler {
 public:
  virtual void ready(TimePoint now) = 0;

 protected:
  ~EventHandler() = default;
};

enum class Interest : std::uint32_t { nothing = 0, read = EPOLLIN, write = EPOLLOUT };

/// Waits for many descriptors at once (epoll).
class Loop {
 public:
  Loop();
  /// False: the kernel had no descriptor left for it.
  bool is_open() const { return epoll_.is_open(); }

  /// False if the kernel refuses (no memory). The handler stays where it is until forget().
  [[nodiscard]] bool watch(int fd, Interest interest, EventHandler& handler);
  void change(int fd, Interest interest, EventHandler& handler);
  /// After this the handler is not called for it any more, not even if it was ready in this round.
  void forget(int fd, const EventHandler& handler);

  /// Waits until a descriptor is ready or the time is over (nullopt: for ever), then calls the handlers, each
  /// with its own time. Returns the time after that.
  TimePoint run_once(std::optional<std::chrono::milliseconds> timeout);

 private:
  Descriptor epoll_;
  /// Few at a time: what becomes ready meanwhile queues behind what was ready before, so nothing waits for
  /// two rounds.
  std::array<epoll_event, 8> events_{};
  int waiting_ = 0;  ///< events of this round
};

}  // namespace coupler::device
