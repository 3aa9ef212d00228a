// SPDX-License-Identifier: Apache-2.0
// Many small Modbus/TCP devices in one thread, each on a loopback port of its own: input registers of which
// each changes at every 50th read, not all at the same one.
//   coupler_bench_driver_devices COUNT [DEAD [SLOW MILLISECONDS]]
// prints the ports on one line, and, for each line that it reads, how often each device has been read.
// The first DEAD devices accept and never answer, the next SLOW answer late.
#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <map>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t request_size = 12;
constexpr unsigned reads_per_change = 50;

struct Device {
  bool dead = false;
  std::chrono::milliseconds delay{0};
  std::uint32_t reads = 0;
};

/// A reply that waits for its time.
struct Late {
  Clock::time_point at;
  int socket;
  std::vector<std::uint8_t> reply;
};

std::vector<std::uint8_t> reply_to(const std::uint8_t* request, Device& device) {
  std::vector<std::uint8_t> reply(request, request + 8);
  const unsigned address = request[8] << 8U | request[9];
  const unsigned count = request[10] << 8U | request[11];
  if (request[7] != 4 || address >= 0xFF00 || count == 0 || count > 125) {
    reply[5] = 3;
    reply[7] = static_cast<std::uint8_t>(request[7] | 0x80);
    reply.push_back(2);
    return reply;
  }
  ++device.reads;
  reply[4] = 0;
  reply[5] = static_cast<std::uint8_t>(3 + 2 * count);
  reply.push_back(static_cast<std::uint8_t>(2 * count));
  for (unsigned i = address; i < address + count; ++i) {
    const unsigned value = (device.reads + 7 * i) / reads_per_change;
    reply.push_back(static_cast<std::uint8_t>(value >> 8));
    reply.push_back(static_cast<std::uint8_t>(value));
  }
  return reply;
}

class Server {
 public:
  explicit Server(std::vector<Device> devices) : devices_(std::move(devices)) {
    for (Device& device : devices_) listen(device);
    std::puts("");
    watch(STDIN_FILENO);
  }

  /// Until stdin ends.
  void run() {
    std::array<epoll_event, 64> events{};
    while (!ended_) {
      std::fflush(stdout);
      const int n = ::epoll_wait(epoll_, events.data(), static_cast<int>(events.size()), send_late());
      for (int i = 0; i < n; ++i) handle(events[static_cast<std::size_t>(i)].data.fd);
    }
  }

 private:
  void watch(int fd) const {
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.fd = fd;
    ::epoll_ctl(epoll_, EPOLL_CTL_ADD, fd, &event);
  }

  void listen(Device& device) {
    const int listener = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (::bind(listener, reinterpret_cast<sockaddr*>(&address), size) != 0 || ::listen(listener, 4) != 0 ||
        ::getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size) != 0)
      std::exit(3);
    std::printf("%d ", ntohs(address.sin_port));
    listeners_[listener] = &device;
    watch(listener);
  }

  void tell() {
    std::array<char, 64> line{};
    ended_ = ::read(STDIN_FILENO, line.data(), line.size()) <= 0;
    for (const Device& device : devices_) std::printf("%u ", device.reads);
    std::puts("");
  }

  void handle(int fd) {
    if (fd == STDIN_FILENO) return tell();
    if (const auto listener = listeners_.find(fd); listener != listeners_.end()) {
      const int connection = ::accept(fd, nullptr, nullptr);
      const int yes = 1;
      ::setsockopt(connection, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
      connections_[connection] = listener->second;
      watch(connection);
      return;
    }
    std::array<std::uint8_t, 256> request{};
    if (::recv(fd, request.data(), request.size(), 0) < static_cast<ssize_t>(request_size)) {
      ::close(fd);
      connections_.erase(fd);
      return;
    }
    Device& device = *connections_.at(fd);
    if (device.dead) return;
    auto reply = reply_to(request.data(), device);
    if (device.delay.count() > 0)
      late_.push_back({Clock::now() + device.delay, fd, std::move(reply)});
    else
      ::send(fd, reply.data(), reply.size(), MSG_NOSIGNAL);
  }

  /// Milliseconds until the next one; -1: there is none.
  int send_late() {
    while (!late_.empty()) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(late_.front().at - Clock::now()).count();
      if (left > 0) return static_cast<int>(left);
      const Late& late = late_.front();
      if (connections_.count(late.socket) != 0)
        ::send(late.socket, late.reply.data(), late.reply.size(), MSG_NOSIGNAL);
      late_.pop_front();
    }
    return -1;
  }

  std::vector<Device> devices_;
  int epoll_ = ::epoll_create1(0);
  std::map<int, Device*> listeners_;
  std::map<int, Device*> connections_;
  std::deque<Late> late_;
  bool ended_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const auto number = [&](int i) { return i < argc ? static_cast<std::size_t>(std::atoi(argv[i])) : 0; };
  std::vector<Device> devices(number(1));
  for (std::size_t i = 0; i < number(2); ++i) devices.at(i).dead = true;
  for (std::size_t i = number(2); i < number(2) + number(3); ++i)
    devices.at(i).delay = std::chrono::milliseconds(number(4));
  Server server(std::move(devices));
  server.run();
}
