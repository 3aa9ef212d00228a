// SPDX-License-Identifier: Apache-2.0
// The floor: as little as can be between a line, a topic and another line. Nothing is checked, nothing comes
// back.
//   coupler_bench_bare sender CHIP INPUT PORT             sends a byte for each edge
//   coupler_bench_bare relay FROM TO                      the same for each byte that comes on another port
//   coupler_bench_bare publisher PORT                     publishes each byte that comes, on bare/input
//   coupler_bench_bare reaction CHIP INPUT OUTPUT NS      repeats each edge so much later, by a timer; prints
//                                                         after how many ns it was done
#include <arpa/inet.h>
#include <linux/gpio.h>
#include <netinet/in.h>
#include <ros/ros.h>
#include <std_msgs/Bool.h>
#include <sys/socket.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "test/bench/kernel/line.hpp"
#include "test/bench/node/lock_step_client.hpp"

namespace coupler::bench {
namespace {

void send_edges(const Line& input, std::uint16_t port) {
  const LockStepClient connection(port);
  std::fprintf(stderr, "sending\n");
  for (;;) {
    const char level = input.next_edge().level ? 1 : 0;
    if (::send(connection.socket(), &level, 1, MSG_NOSIGNAL) != 1) return;
  }
}

/// The first connection to the port.
int accept_on(std::uint16_t port, const char* says) {
  const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int on = 1;
  ::setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(listener, 1) != 0)
    give_up("cannot listen");
  std::fprintf(stderr, "%s\n", says);
  return ::accept(listener, nullptr, nullptr);
}

void relay(std::uint16_t from, std::uint16_t to) {
  const LockStepClient connection(to);
  const int socket = accept_on(from, "relaying");
  for (char level = 0; ::recv(socket, &level, 1, 0) == 1;)
    if (::send(connection.socket(), &level, 1, MSG_NOSIGNAL) != 1) return;
}

void publish_bytes(std::uint16_t port) {
  ros::NodeHandle handle;
  auto publisher = handle.advertise<std_msgs::Bool>("bare/input", 10);
  const int socket = accept_on(port, "publishing");
  std_msgs::Bool message;
  for (char level = 0; ::recv(socket, &level, 1, 0) == 1;) {
    message.data = level != 0;
    publisher.publish(message);
  }
}

void react(const Line& input, const Line& output, long long delay) {
  constexpr long long second = 1'000'000'000;
  const int timer = ::timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC);
  std::fprintf(stderr, "reacting\n");
  for (;;) {
    const Line::Edge edge = input.next_edge();
    const long long due = edge.at + delay;
    itimerspec when{};
    when.it_value = {due / second, due % second};
    std::uint64_t expirations = 0;
    if (::timerfd_settime(timer, TFD_TIMER_ABSTIME, &when, nullptr) != 0 ||
        ::read(timer, &expirations, sizeof expirations) != sizeof expirations)
      give_up("cannot wait");
    output.drive(edge.level);
    timespec done{};
    ::clock_gettime(CLOCK_MONOTONIC, &done);
    std::printf("timer %lld\n", done.tv_sec * second + done.tv_nsec - edge.at);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace coupler::bench

int main(int argc, char** argv) {
  using namespace coupler::bench;
  ros::init(argc, argv, "bare", ros::init_options::NoSigintHandler);
  const std::string_view role = argc > 1 ? argv[1] : "";
  const auto port = [&](int i) { return static_cast<std::uint16_t>(std::atoi(argv[i])); };
  const auto line = [&](int i, unsigned long long flags) {
    return Line(argv[2], static_cast<unsigned>(std::atoi(argv[i])), flags);
  };
  if (role == "sender" && argc == 5)
    send_edges(line(3, both_edges), port(4));
  else if (role == "relay" && argc == 4)
    relay(port(2), port(3));
  else if (role == "publisher" && argc == 3)
    publish_bytes(port(2));
  else if (role == "reaction" && argc == 6)
    react(line(3, both_edges), line(4, GPIO_V2_LINE_FLAG_OUTPUT), std::atoll(argv[5]));
  else
    return 2;
  return 0;
}
