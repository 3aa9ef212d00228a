// SPDX-License-Identifier: Apache-2.0
// The floor: the least that a program of roscpp and libmodbus can do. It reads one range and publishes each
// value; it subscribes to one topic and writes. No map, no checks, no reconnect.
//   coupler_bench_driver_floor PORT di|ir|coil|hr COUNT
#include <modbus/modbus.h>
#include <ros/ros.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Int16.h>

#include <array>
#include <cstdlib>
#include <mutex>
#include <string>
#include <vector>

namespace {

struct Device {
  modbus_t* context = nullptr;
  std::mutex busy;
};

template <class M>
std::vector<ros::Publisher> advertise(ros::NodeHandle& handle, int count) {
  std::vector<ros::Publisher> publishers;
  publishers.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    publishers.push_back(handle.advertise<M>("bench/p" + std::to_string(i), 10));
  return publishers;
}

/// Ten times a second.
template <class M, class Read>
void poll(ros::NodeHandle& handle, int count, Read read) {
  auto publishers = advertise<M>(handle, count);
  M message;
  ros::WallRate rate(10);
  while (ros::ok()) {
    const auto* values = read();
    for (std::size_t i = 0; values != nullptr && i < publishers.size(); ++i) {
      message.data = static_cast<typename M::_data_type>(values[i]);
      publishers[i].publish(message);
    }
    rate.sleep();
  }
}

template <class M, class Write>
void listen(ros::NodeHandle& handle, Device& device, Write write) {
  const auto receive = [&](const boost::shared_ptr<const M>& message) {
    const std::lock_guard lock(device.busy);
    write(message->data);
  };
  const auto subscriber = handle.subscribe<M>(
      "bench/p0/write", 10, boost::function<void(const boost::shared_ptr<const M>&)>(receive),
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  ros::AsyncSpinner spinner(1);
  spinner.start();
  ros::waitForShutdown();
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "bench_driver");
  if (argc != 4) return 2;
  const std::string table = argv[2];
  const int count = std::atoi(argv[3]);
  Device device;
  device.context = modbus_new_tcp("127.0.0.1", std::atoi(argv[1]));
  modbus_set_slave(device.context, 1);
  if (modbus_connect(device.context) != 0) return 3;

  ros::NodeHandle handle;
  std::array<std::uint8_t, MODBUS_MAX_READ_BITS> bits{};
  std::array<std::uint16_t, MODBUS_MAX_READ_REGISTERS> registers{};
  if (table == "di") {
    poll<std_msgs::Bool>(handle, count, [&] {
      return modbus_read_input_bits(device.context, 0, count, bits.data()) == count ? bits.data() : nullptr;
    });
  } else if (table == "ir") {
    poll<std_msgs::Int16>(handle, count, [&] {
      return modbus_read_input_registers(device.context, 0, count, registers.data()) == count
                 ? registers.data()
                 : nullptr;
    });
  } else if (table == "coil") {
    listen<std_msgs::Bool>(handle, device, [&](bool on) { modbus_write_bit(device.context, 0, on ? 1 : 0); });
  } else {
    listen<std_msgs::Int16>(handle, device, [&](std::int16_t value) {
      modbus_write_register(device.context, 0, static_cast<std::uint16_t>(value));
    });
  }
  modbus_close(device.context);
  modbus_free(device.context);
  return 0;
}
