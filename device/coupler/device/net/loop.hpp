// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/epoll.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>

#include "coupler/device/core/time.hpp"
#include "coupler/device/net/descriptor.hpp"

namespace coupler::device {

/// Whoever waits for a descriptor. `ready` comes again as long as the descriptor stays ready, and may come
/// without reason: only non-blocking calls are safe in it.
class Watcher {
 public:
  virtual void ready(TimePoint now) = 0;

 protected:
  ~Watcher() = default;
};

enum class Interest : std::uint32_t { nothing = 0, read = EPOLLIN, write = EPOLLOUT };

/// Waits for many descriptors at once (epoll).
class Loop {
 public:
  Loop();
  /// False: the kernel had no descriptor left for it.
  bool is_open() const { return epoll_.is_open(); }

  /// False if the kernel refuses (no memory). The watcher stays where it is until forget().
  [[nodiscard]] bool watch(int fd, Interest interest, Watcher& watcher);
  void change(int fd, Interest interest, Watcher& watcher);
  /// After this no call comes for it, not even one that was already on its way.
  void forget(int fd, const Watcher& watcher);

  /// Waits until something is ready or the time is over (nullopt: for ever), then calls who is concerned.
  /// Returns the time when it was.
  TimePoint run_once(std::optional<std::chrono::milliseconds> timeout);

 private:
  Descriptor epoll_;
  /// Few at a time: who becomes ready meanwhile queues behind who was there before, and nobody waits two
  /// rounds.
  std::array<epoll_event, 8> events_{};
  int waiting_ = 0;  ///< events of this round
};

}  // namespace coupler::device
