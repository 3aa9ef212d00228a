// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/device/net/loop.hpp"
#include "coupler/device/net/open_connection.hpp"
#include "coupler/device/supervisor/heartbeat.hpp"
#include "coupler/device/supervisor/silence.hpp"

namespace coupler::device {

/// The supervisor, as its worker process knows it: hears that its loop turns, tells the same of its own, may
/// ask it to make room for another one, and takes its clients over.
class SupervisorLink : public Heartbeat, public Watcher {
 public:
  /// `channel` is a connected socket that keeps messages apart.
  explicit SupervisorLink(Descriptor channel) : channel_(std::move(channel)) {}

  /// Listens to it from now on.
  void watch(Loop& loop);

  void beat() override;
  /// It asked this process to give its clients away and end.
  bool wants_room() const { return wants_room_; }
  void give(const OpenConnection& client);

  /// A supervisor that was not heard of for so long is stopped, or hangs, and would not see its worker
  /// process die.
  static constexpr std::chrono::seconds timeout = Silence::limit_in_any_case;
  /// To be asked in each turn of the loop.
  bool is_silent(TimePoint now);

  void ready(TimePoint now) override;

 private:
  Descriptor channel_;
  Loop* loop_ = nullptr;
  bool wants_room_ = false;
  bool heard_ = true;  ///< since is_silent() was asked
  Silence silence_{TimePoint::clock::now(), Heartbeat::period, std::chrono::nanoseconds(0)};
};

}  // namespace coupler::device
