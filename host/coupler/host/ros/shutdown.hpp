// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>

namespace coupler::host {

/// Once the outputs are as the driver leaves them: so long ROS and disks may take before another signal ends
/// the driver at once (Shutdown::begin_to_end()).
constexpr auto patience_after_outputs = std::chrono::seconds(2);

/// How coupler::ending_signals (SIGINT, SIGTERM, SIGHUP, …) end a driver.
struct Shutdown {
  static std::atomic<bool> requested;  ///< by a signal, or a failed thread; every wait looks at it
  static std::atomic<bool> has_failed_thread;

  /// Before an output may be driven: from now on the shutdown must be orderly. Does not return if a second
  /// signal ends the program at this moment.
  static void begin_driving();
  /// Returns whether begin_driving() was called.
  static bool is_driving();

  /// The rest takes as long as devices, ROS and disks take. After `patience` a signal, SIGALRM too, exits
  /// with this code, but not sooner, since a launch tool may pass on a signal that the terminal has sent,
  /// too.
  static void begin_to_end(int exit_code, std::chrono::seconds patience);

  /// A signal exits with status 0, as long as nothing has been started that would have to be stopped.
  static void exit_on_signals();
  /// A signal calls this; a second one exits, since ROS may wait for a master that does not answer.
  static void unregister_on_signals(void (*shut_down)());
  /// A signal sets `requested`. While nothing has been driven a second one exits at once, so that nobody has
  /// to wait for a device or a ROS master that does not answer.
  static void request_on_signals();
};

}  // namespace coupler::host
