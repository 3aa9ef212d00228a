// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/node_handle.h>

namespace coupler::host {

/// Answers `~get_loggers` in place of roscpp. Its own answer asks log4cxx for a list of loggers, which
/// Debian's librosconsole gives back damaged: the program dies, then or at its end, whatever it is (a talker
/// of five lines, too). rqt_logger_level asks as soon as a node is chosen; a driver of outputs must outlive
/// that.
/// `~set_logger_level` stays roscpp's: that works.
ros::ServiceServer advertise_loggers();

}  // namespace coupler::host
