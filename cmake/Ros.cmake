# SPDX-License-Identifier: Apache-2.0
# The ROS driver's messages, and coupler_ros: what a target links that includes headers of ROS. Sets COUPLER_WITH_ROS to the
# version of ROS that is there, 1 or 2, or to OFF. coupler/host/ros has what both need; the target coupler_ros differs.
set(COUPLER_WITH_ROS OFF)
set(messages BoolArray.msg PointStatus.msg Status.msg)
set(services Read.srv Write.srv)
set(left_out "no catkin, roscpp, std_srvs, diagnostic_updater or libmodbus, or COUPLER_ROS=OFF; scripts/install-packages build ros")
if(NOT COUPLER_ROS STREQUAL OFF AND libmodbus_FOUND)
  include(Ros${COUPLER_ROS_VERSION})
endif()

if(NOT COUPLER_WITH_ROS)
  message(STATUS "Left out: coupler_driver, the ROS driver (${left_out})")
endif()

# Programs are in build/<preset>/bin. In a catkin workspace catkin's own choice stands, so that rosrun finds them.
if(NOT COUPLER_WITH_ROS EQUAL 1 OR plain)
  set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
  set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
endif()
