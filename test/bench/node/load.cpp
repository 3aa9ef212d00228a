// SPDX-License-Identifier: Apache-2.0
// Loads one server with one case and prints what it took as a line of JSON.
#include <fmt/format.h>
#include <sys/epoll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <deque>
#include <utility>
#include <vector>

#include "lock_step_client.hpp"

namespace coupler::bench {
namespace {

using Clients = std::deque<LockStepClient>;

struct Load {
  std::uint16_t port;
  Case what;
  std::size_t connections;
  std::size_t idle;
  std::size_t requests;
};

struct Result {
  LockStepClient::Clock::duration whole;
  std::vector<LockStepClient::Clock::duration> each;  ///< in the order of the replies
};

Clients connect(std::size_t count, const Load& load) {
  Clients clients;
  for (std::size_t i = 0; i < count; ++i)
    clients.emplace_back(load.port).ask_and_wait(load.what.exchanges[0]);
  return clients;
}

/// Keeps every client's request in flight until all replies are there.
Result run(Clients& clients, const Load& load) {
  constexpr int patience_ms = 5000;
  const int epoll = ::epoll_create1(EPOLL_CLOEXEC);
  for (LockStepClient& client : clients) {
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.ptr = &client;
    if (::epoll_ctl(epoll, EPOLL_CTL_ADD, client.socket(), &event) != 0) give_up("cannot wait for replies");
  }
  std::vector<LockStepClient::Clock::duration> each(load.requests);
  std::size_t asked = 0;
  std::size_t answered = 0;
  const auto ask = [&](LockStepClient& client) {
    client.ask(load.what.exchanges[asked++ % load.what.exchanges.size()]);
  };

  const auto start = LockStepClient::Clock::now();
  for (LockStepClient& client : clients)
    if (asked < load.requests) ask(client);
  std::array<epoll_event, 16> events;
  while (answered < load.requests) {
    errno = 0;
    const int count = ::epoll_wait(epoll, events.data(), static_cast<int>(events.size()), patience_ms);
    if (count <= 0) give_up("no reply in 5 s");
    for (int i = 0; i < count; ++i) {
      auto& client = *static_cast<LockStepClient*>(events[static_cast<std::size_t>(i)].data.ptr);
      const auto needed = client.take();
      if (!needed) continue;
      each[answered++] = *needed;
      if (asked < load.requests) ask(client);
    }
  }
  const auto end = LockStepClient::Clock::now();
  ::close(epoll);
  return {end - start, std::move(each)};
}

/// Nearest rank, in µs.
double percentile(const std::vector<LockStepClient::Clock::duration>& sorted, double share) {
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(sorted.size()));
  return std::chrono::duration<double, std::micro>(sorted[std::min(rank, sorted.size() - 1)]).count();
}

void measure(const Load& load) {
  if (load.what.preparation) LockStepClient(load.port).ask_and_wait(*load.what.preparation);
  Clients idle = connect(load.idle, load);
  Clients clients = connect(load.connections, load);
  Result result = run(clients, load);
  const auto closed = std::count_if(idle.begin(), idle.end(),
                                    [](const LockStepClient& client) { return client.was_closed(); });
  std::sort(result.each.begin(), result.each.end());
  fmt::print(
      R"({{"per_second": {:.1f}, "p50_us": {:.2f}, "p99_us": {:.2f}, "max_us": {:.2f}, "idle_closed": {}}})"
      "\n",
      static_cast<double>(load.requests) / std::chrono::duration<double>(result.whole).count(),
      percentile(result.each, 0.50), percentile(result.each, 0.99), percentile(result.each, 1), closed);
}

}  // namespace
}  // namespace coupler::bench

int main(int argc, char** argv) {
  using namespace coupler::bench;
  const auto what = argc == 6 ? find_case(argv[2]) : std::nullopt;
  const auto number = [&](int i) { return std::strtoul(argv[i], nullptr, 10); };
  if (!what || number(3) == 0 || number(5) == 0) {
    fmt::print(stderr,
               "usage: {} PORT CASE CONNECTIONS IDLE REQUESTS\n"
               "  CASE: fc3 (10 registers), fc1 (32 coils), fc5 (one coil); IDLE: connections beside\n"
               "  Example: {} 1502 fc3 16 0 20000\n",
               argv[0], argv[0]);
    return 2;
  }
  measure({static_cast<std::uint16_t>(number(1)), *what, number(3), number(4), number(5)});
  return 0;
}
