// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

#include "host/ros/rival_warnings.hpp"
#include "host/ros1/registrations.hpp"

namespace coupler::driver {

/// Makes this node known to a ROS master that has started again: roscpp would stay invisible for ever. The
/// devices go on meanwhile. In a thread of its own, since a master may take its time.
class MasterWatch {
 public:
  /// All topics and services must have been advertised.
  explicit MasterWatch(Log& log);
  /// Waits for the question to the master in progress.
  ~MasterWatch();
  MasterWatch(const MasterWatch&) = delete;
  MasterWatch& operator=(const MasterWatch&) = delete;

 private:
  void run();
  void look();
  void learn();

  Log& log_;
  Registrations registrations_;
  unsigned looks_ = 0;
  RivalWarnings rivals_;
  Registrations::Known known_ = Registrations::Known::yes;
  std::mutex mutex_;
  std::condition_variable ends_;
  bool ended_ = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace coupler::driver
