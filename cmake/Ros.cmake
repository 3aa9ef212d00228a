# SPDX-License-Identifier: Apache-2.0
# The ROS driver's messages, and which ROS is looked for. Ros1.cmake or Ros2.cmake, if it is there, makes coupler_ros, which a
# target links that includes headers of ROS, and sets COUPLER_WITH_ROS to its version.
set(COUPLER_WITH_ROS OFF)
set(messages BoolArray.msg BoolSample.msg BoolStamped.msg Float64Sample.msg Float64Stamped.msg Int64Sample.msg Int64Stamped.msg
             PointInfo.msg PointQuality.msg PointStatus.msg Points.msg Scheduled.msg ScheduledWrite.msg Status.msg
             StringSample.msg StringStamped.msg ToolState.msg UInt64Sample.msg UInt64Stamped.msg)
set(actions WaitFor.action)
set(services CancelScheduled.srv ListScheduled.srv Read.srv Schedule.srv Write.srv)
set(left_out "no libmodbus, or COUPLER_ROS=OFF; scripts/install-packages build")
if(COUPLER_ROS STREQUAL OFF OR NOT libmodbus_FOUND)
  set(COUPLER_ROS_VERSION OFF)
endif()
