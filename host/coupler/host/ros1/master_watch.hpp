// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/host/ros/recurring.hpp"
#include "coupler/host/ros/rival_warnings.hpp"
#include "coupler/host/ros1/registrations.hpp"

namespace coupler::host {

/// Makes this node known to a ROS master that has started again: roscpp would stay invisible for ever. The
/// devices go on meanwhile. In a thread of its own, since a master may take its time.
class MasterWatch {
 public:
  /// All topics and services must have been advertised.
  explicit MasterWatch(Log& log);

 private:
  void look();
  void learn();

  Log& log_;
  Registrations registrations_;
  unsigned looks_ = 0;
  RivalWarnings rivals_;
  Registrations::Known known_ = Registrations::Known::yes;
  Recurring recurring_;  // last: it uses the others
};

}  // namespace coupler::host
