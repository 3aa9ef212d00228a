// SPDX-License-Identifier: Apache-2.0
// The floor in ROS 2: the least that a program of rcl and libmodbus can do. A thread for each device reads
// one range and publishes each value; or one subscribes to one topic and writes. No map, no checks, no
// reconnect.
//   coupler_bench_driver_floor PORT di|ir|coil|hr COUNT      bench/p0 …, ten times a second
//   coupler_bench_driver_floor PORT,PORT… di|ir COUNT HZ     d0/p0 …, those that have changed
#include <modbus/modbus.h>
#include <rcl/rcl.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <std_msgs/msg/bool.hpp>
#include <std_msgs/msg/int16.hpp>

#include "test/bench/driver/ros2/session.hpp"

namespace {

using bench::check;
using Clock = std::chrono::steady_clock;

modbus_t* connect(int port) {
  modbus_t* device = modbus_new_tcp("127.0.0.1", port);
  modbus_set_slave(device, 1);
  if (modbus_connect(device) != 0) std::exit(3);
  return device;
}

void disconnect(modbus_t* device) {
  modbus_close(device);
  modbus_free(device);
}

struct Polled {
  std::string name;
  modbus_t* device;
  std::vector<rcl_publisher_t> publishers;
};

struct Pace {
  Clock::duration period;
  bool on_change;
};

/// Until the end. `read`: libmodbus's function for the table.
template <class M, class Value>
void poll(const Polled& polled, Pace pace, int (*read)(modbus_t*, int, int, Value*)) {
  const int count = static_cast<int>(polled.publishers.size());
  std::vector<Value> values(polled.publishers.size());
  std::vector<Value> before;
  M message;
  for (auto next = Clock::now(); !bench::ended; std::this_thread::sleep_until(next)) {
    // What is too late is left out; the others stay in step, so that a delay does not make all devices'
    // cycles begin at once for ever.
    for (const auto now = Clock::now(); next <= now;) next += pace.period;
    if (read(polled.device, 0, count, values.data()) != count) continue;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (pace.on_change && !before.empty() && values[i] == before[i]) continue;
      message.data = static_cast<decltype(message.data)>(values[i]);
      check(rcl_publish(&polled.publishers[i], &message, nullptr));
    }
    before = values;
  }
}

template <class M, class Value>
void poll_all(bench::Session& session, const std::vector<int>& ports, int count, Pace pace,
              int (*read)(modbus_t*, int, int, Value*)) {
  std::deque<Polled> all;
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < ports.size(); ++i) {
    Polled& polled =
        all.emplace_back(Polled{pace.on_change ? "d" + std::to_string(i) : "bench", connect(ports[i]), {}});
    for (int p = 0; p < count; ++p)
      polled.publishers.push_back(session.publish<M>(polled.name + "/p" + std::to_string(p)));
    threads.emplace_back([&polled, pace, read] { poll<M>(polled, pace, read); });
    std::printf("%s: connected\n", polled.name.c_str());
  }
  std::fflush(stdout);
  for (std::thread& thread : threads) thread.join();
  for (Polled& polled : all) {
    for (rcl_publisher_t& publisher : polled.publishers) session.end(publisher);
    disconnect(polled.device);
  }
}

template <class M, class Write>
void listen(bench::Session& session, Write write) {
  rcl_subscription_t subscription = session.subscribe<M>("bench/p0/write");
  rcl_wait_set_t waits = rcl_get_zero_initialized_wait_set();
  check(rcl_wait_set_init(&waits, 1, 0, 0, 0, 0, 0, session.context(), rcl_get_default_allocator()));
  M message;
  rmw_message_info_t info;
  while (!bench::ended) {
    check(rcl_wait_set_clear(&waits));
    check(rcl_wait_set_add_subscription(&waits, &subscription, nullptr));
    const rcl_ret_t woken = rcl_wait(&waits, RCL_MS_TO_NS(500));  // to see the end
    if (woken == RCL_RET_TIMEOUT) continue;
    check(woken);
    if (rcl_take(&subscription, &message, &info, nullptr) == RCL_RET_OK) write(message.data);
  }
  check(rcl_wait_set_fini(&waits));
  session.end(subscription);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4 && argc != 5) return 2;
  std::vector<int> ports;
  std::istringstream words(argv[1]);
  for (std::string word; std::getline(words, word, ',');) ports.push_back(std::atoi(word.c_str()));
  const std::string table = argv[2];
  const int count = std::atoi(argv[3]);
  const double rate = argc == 5 ? std::atof(argv[4]) : 10;
  const Pace pace{std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / rate)),
                  argc == 5};

  bench::Session session("bench_floor");
  if (table == "di") {
    poll_all<std_msgs::msg::Bool>(session, ports, count, pace, modbus_read_input_bits);
  } else if (table == "ir") {
    poll_all<std_msgs::msg::Int16>(session, ports, count, pace, modbus_read_input_registers);
  } else {
    modbus_t* device = connect(ports.at(0));
    if (table == "coil")
      listen<std_msgs::msg::Bool>(session, [&](bool on) { modbus_write_bit(device, 0, on ? 1 : 0); });
    else
      listen<std_msgs::msg::Int16>(session, [&](std::int16_t value) {
        modbus_write_register(device, 0, static_cast<std::uint16_t>(value));
      });
    disconnect(device);
  }
}
