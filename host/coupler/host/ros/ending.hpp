// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace coupler::host {

/// How SIGINT and SIGTERM end a driver.
struct Ending {
  static std::atomic<bool> asked;    ///< by a signal; whoever waits looks at it
  static std::atomic<bool> driving;  ///< outputs may have been driven, so it has to end in order

  /// As long as nothing has been started that would have to be ended: exit status 0.
  static void at_once_on_signals();
  /// Sets `asked`. While nothing is driven the second signal ends at once, for one who waits for a device or
  /// a ROS master that is not there.
  static void in_order_on_signals();
};

}  // namespace coupler::host
