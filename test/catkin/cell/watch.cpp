// SPDX-License-Identifier: Apache-2.0
#include <coupler_driver/Status.h>
#include <ros/ros.h>

void show(const coupler_driver::StatusConstPtr& now) {
  ROS_INFO("%s", now->online ? "online" : now->trouble.c_str());
}

int main(int argc, char** argv) {
  ros::init(argc, argv, "watch");
  ros::NodeHandle node;
  const ros::Subscriber status = node.subscribe("cell/status", 1, show);
  ros::spin();
}
