// SPDX-License-Identifier: Apache-2.0
// The ROS side of a measurement: listens to bench/p0 … (or NAME/p0 … for each name), or writes bench/p0/write
// ten times a second at times of its own, so that writes fall everywhere between two polls.
//   coupler_bench_driver_listener di|ir|coil|hr COUNT [NAME…]
#include <ros/ros.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Int16.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace {

template <class M>
void listen(ros::NodeHandle& handle, int count, const std::vector<std::string>& names) {
  const auto receive = [](const boost::shared_ptr<const M>&) {};
  const auto hints = ros::TransportHints().tcpNoDelay();
  std::vector<ros::Subscriber> subscribers;
  for (const std::string& name : names)
    for (int i = 0; i < count; ++i)
      subscribers.push_back(
          handle.subscribe<M>(name + "/p" + std::to_string(i), 10, receive, ros::VoidConstPtr(), hints));
  ros::spin();
}

template <class M>
void write(ros::NodeHandle& handle) {
  auto publisher = handle.advertise<M>("bench/p0/write", 10);
  M message;
  for (ros::WallRate rate(9.7); ros::ok(); rate.sleep()) {
    message.data = static_cast<typename M::_data_type>(1 - message.data);
    publisher.publish(message);
  }
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "bench_listener");
  if (argc < 3) return 2;
  ros::NodeHandle handle;
  const std::string table = argv[1];
  const int count = std::atoi(argv[2]);
  std::vector<std::string> names(argv + 3, argv + argc);
  if (names.empty()) names.emplace_back("bench");
  if (table == "di")
    listen<std_msgs::Bool>(handle, count, names);
  else if (table == "ir")
    listen<std_msgs::Int16>(handle, count, names);
  else if (table == "coil")
    write<std_msgs::Bool>(handle);
  else
    write<std_msgs::Int16>(handle);
  return 0;
}
