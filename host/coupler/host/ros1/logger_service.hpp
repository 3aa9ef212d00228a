// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>

namespace coupler::host {

/// Answers `~get_loggers` in place of roscpp, in the threads of `queue`. roscpp's own answer asks log4cxx for
/// a list of loggers, which Debian's librosconsole returns damaged: any program crashes, then or at its end.
/// rqt_logger_level asks as soon as a node is chosen, and a driver of outputs must survive that.
/// `~set_logger_level` stays roscpp's, which works.
ros::ServiceServer advertise_loggers(ros::CallbackQueueInterface& queue);

}  // namespace coupler::host
