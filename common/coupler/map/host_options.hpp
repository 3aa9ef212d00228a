// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

#include "coupler/base/enumeration.hpp"
#include "coupler/base/span.hpp"

namespace coupler {

/// How the host treats one point. Nothing of it concerns the coupler: it is not in the fingerprint.
struct HostOptions {
  enum class Publish : std::uint8_t { always, on_change };
  /// Which function codes write it.
  enum class WriteFunction : std::uint8_t {
    automatic,  ///< 5 or 6 for one address, 15 or 16 for several
    single,     ///< 5 or 6 only: never merged with its neighbours
    multiple    ///< 15 or 16, also for one address
  };
  /// What a value does to those of the same point that still wait to be sent.
  enum class WriteQueue : std::uint8_t {
    latest,  ///< replaces one that is last in the queue
    every    ///< every value is sent, by itself
  };
  /// No message for so long: the value is written.
  struct Deadman {
    std::chrono::milliseconds timeout{0};  ///< 0: none
    Span<const std::uint16_t> value{};     ///< as Point::initial

    constexpr bool present() const { return timeout.count() > 0; }
  };

  double rate = 0;  ///< Hz; 0: the map's
  Publish publish = Publish::always;
  double deadband = 0;  ///< with on_change: published when it differs from the last by more
  std::chrono::milliseconds max_interval{
      0};  ///< with on_change: published at least so often; 0: never for that
  bool latch = false;
  std::uint32_t queue_size = 10;  ///< of the topic; its subscription to writes holds ten times as many
  WriteFunction write_function = WriteFunction::automatic;
  WriteQueue write_queue = WriteQueue::latest;
  bool verify_write = false;  ///< read back after a write
  Deadman deadman{};
};

constexpr Enumeration<HostOptions::Publish, 2> enumeration(HostOptions::Publish) {
  using Publish = HostOptions::Publish;
  return {"HostOptions::Publish", {{Publish::always, "always"}, {Publish::on_change, "on_change"}}};
}
constexpr Enumeration<HostOptions::WriteFunction, 3> enumeration(HostOptions::WriteFunction) {
  using Function = HostOptions::WriteFunction;
  return {"HostOptions::WriteFunction",
          {{Function::automatic, "automatic", ""},
           {Function::single, "single"},
           {Function::multiple, "multiple"}}};
}
constexpr Enumeration<HostOptions::WriteQueue, 2> enumeration(HostOptions::WriteQueue) {
  using Queue = HostOptions::WriteQueue;
  return {"HostOptions::WriteQueue", {{Queue::latest, "latest"}, {Queue::every, "every"}}};
}

}  // namespace coupler
