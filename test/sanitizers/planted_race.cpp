// SPDX-License-Identifier: Apache-2.0
// A data race on purpose, in a callback that roscpp calls: if ThreadSanitizer with our suppressions does not
// report it, the suppressions hide real races. test/sanitizers/canary runs it.
#include <ros/ros.h>
#include <std_msgs/Int32.h>

namespace {

int planted = 0;

void on_message(const std_msgs::Int32::ConstPtr& message) { planted += message->data; }

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "planted_race", ros::init_options::NoRosout);
  ros::NodeHandle node;
  ros::AsyncSpinner spinner(1);
  spinner.start();
  const ros::Publisher publisher = node.advertise<std_msgs::Int32>("planted", 1);
  const ros::Subscriber subscriber = node.subscribe("planted", 1, on_message);
  std_msgs::Int32 one;
  one.data = 1;
  // halt_on_error ends it long before, as soon as a message has come and both have added to it.
  for (int i = 0; i < 10000 && ros::ok(); ++i) {
    publisher.publish(one);
    planted += 1;
    ros::WallDuration(0.02).sleep();
  }
  return planted == 0 ? 1 : 0;
}
