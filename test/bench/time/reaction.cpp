// SPDX-License-Identifier: Apache-2.0
// The closed loop: an output follows an input after a delay. Through ROS (the stamp of the input's message,
// the service schedule) and by a bare timer, in turn. Each line of its output: "driver", and the ns from the
// kernel's stamp of the input's edge to when the node had driven its output, as it tells a client that waits
// for changes: a program that looked at the wire would run behind all that ROS does then, with one processor.
// The timer prints its own.
//   coupler_bench_reaction CHIP WIRES ROUNDS NS       in the test kernel: line 4 → 6 (driver), 3 → 7 (timer)
#include <coupler_driver/BoolStamped.h>
#include <coupler_driver/Schedule.h>
#include <sys/socket.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "coupler/modbus/changes.hpp"
#include "coupler/modbus/limits.hpp"
#include "test/bench/time/heard.hpp"
#include "test/bench/time/known_edges.hpp"

namespace coupler::bench {
namespace {

using coupler_driver::BoolStamped;
using coupler_driver::Schedule;

constexpr int repetitions = 5;
constexpr std::uint16_t node_port = 1502;
constexpr std::size_t header = 7;  ///< of a frame

/// Hears of a node's changes.
class Changes {
 public:
  Changes() : client_(node_port) { ask(); }

  /// When the coil with address 0 got this level, CLOCK_MONOTONIC.
  std::int64_t coil_became(bool level) {
    using modbus::Change;
    for (;;) {
      const modbus::ChangesReply reply = ask();
      for (const Change& change : reply.all())
        if (change.table == 1 && (change.kind == Change::Kind::on) == level) return change.at.count();
    }
  }

 private:
  modbus::ChangesReply ask() {
    std::array<std::uint8_t, header + modbus::max_pdu_size> frame{0, 0, 0, 0, 0, 0, 255};
    const std::size_t size = modbus::build_changes_request(request_, {&frame[header], modbus::max_pdu_size});
    frame[header - 2] = static_cast<std::uint8_t>(size + 1);
    if (::send(client_.socket(), frame.data(), header + size, MSG_NOSIGNAL) < 0) give_up("cannot send");
    if (::recv(client_.socket(), frame.data(), header, MSG_WAITALL) != header) give_up("the node ended");
    const std::size_t length = std::size_t{frame[header - 2]} - 1;
    if (::recv(client_.socket(), &frame[header], length, MSG_WAITALL) != static_cast<ssize_t>(length))
      give_up("the node ended");
    const auto reply = modbus::parse_changes_reply({&frame[header], length});
    if (!reply) give_up("the node does not tell changes");
    const bool begins = request_.epoch != reply->epoch;
    request_ = {30000, reply->epoch, begins ? reply->newest : request_.seen + reply->lost + reply->count};
    return *reply;
  }

  LockStepClient client_;
  modbus::ChangesRequest request_{0, 0, 0};
};

void compare(const char* chip, const std::string& wires, int rounds, std::int64_t delay) {
  const KnownEdges edges(chip, wires);
  ros::NodeHandle handle;
  Heard<BoolStamped> input(handle, "plant/stamped_input/stamped");
  ros::AsyncSpinner spinner(1);
  spinner.start();
  input.wait_for([](const BoolStamped& message) { return message.value == 0; });
  if (!ros::service::waitForService("plant/schedule", 60'000)) give_up("there is no service");
  auto schedule = handle.serviceClient<Schedule>("plant/schedule", true);
  // False: this machine was kept waiting until the time had passed, and it is a later one.
  const auto schedule_it = [&](bool level) {
    const auto told =
        input.wait_for([&](const BoolStamped& message) { return (message.value != 0) == level; });
    Schedule call;
    call.request.point = "output";
    call.request.value = level ? "true" : "false";
    for (std::int64_t after = delay;; after *= 2) {
      call.request.at = told.message->header.stamp + ros::Duration(static_cast<double>(after) / 1e9);
      if (!schedule.call(call)) give_up("the service has ended");
      if (call.response.success) return after == delay;
      const std::string& why = call.response.message;
      const bool is_past = why.find(" s past") != std::string::npos;
      if (!is_past && why.find("exception 03") == std::string::npos) give_up(why.c_str());
    }
  };
  const Wire of_driver(wires + "/sim_gpio4");
  const Wire of_timer(wires + "/sim_gpio3");
  Changes changes;
  bool level = false;
  bool of_timer_level = false;
  for (int run = 0; run < repetitions; ++run) {
    for (int i = 0; i < rounds; ++i) {
      level = !level;
      edges.pull(of_driver, level);
      const bool in_time = schedule_it(level);
      const std::int64_t driven = changes.coil_became(level);
      if (const auto edge = edges.stamp(); edge && in_time)
        std::printf("driver %lld\n", static_cast<long long>(driven - edge->earliest));
    }
    for (int i = 0; i < rounds; ++i) {
      of_timer_level = !of_timer_level;
      of_timer.pull(of_timer_level);
      std::this_thread::sleep_for(std::chrono::nanoseconds(delay) + std::chrono::milliseconds(30));
    }
  }
}

}  // namespace
}  // namespace coupler::bench

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  ros::init(argc, argv, "reaction", ros::init_options::NoSigintHandler);
  coupler::bench::compare(argv[1], argv[2], std::atoi(argv[3]), std::atoll(argv[4]));
  return 0;
}
