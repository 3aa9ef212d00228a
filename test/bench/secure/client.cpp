// SPDX-License-Identifier: Apache-2.0
// Reads ten registers again and again, each time the answer to the last has come, and prints how long that
// took.
//   coupler_bench_secure PORT SECONDS [CERTIFICATE KEY CA]     with the files by TLS
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "coupler/host/modbus/make_links.hpp"

int main(int argc, char** argv) {
  using namespace coupler;
  using Clock = std::chrono::steady_clock;
  if (argc != 3 && argc != 6) return 2;
  Connection connection;
  connection.address = "127.0.0.1";
  connection.port = static_cast<std::uint16_t>(std::atoi(argv[1]));
  connection.timeout = std::chrono::seconds(10);
  if (argc == 6) connection.tls = {argv[3], argv[4], argv[5], {}, {}, {}};
  host::Link link = host::make_link(connection);
  const auto give_up = [](const host::Error& error) {
    std::fprintf(stderr, "%s\n", host::to_string(error).c_str());
    return 3;
  };
  if (const auto connected = link.connect(); !connected) return give_up(connected.error());
  std::array<std::uint16_t, 10> registers{};
  std::vector<double> times;  // µs
  const auto began = Clock::now();
  const auto until =
      began + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::atof(argv[2])));
  for (auto now = began; now < until;) {
    const auto read = link.read(Table::holding_registers, modbus::Range::of(0, 10), registers.data());
    if (!read) return give_up(read.error());
    const auto after = Clock::now();
    times.push_back(std::chrono::duration<double, std::micro>(after - now).count());
    now = after;
  }
  std::sort(times.begin(), times.end());
  const auto at = [&](double part) {
    return times[static_cast<std::size_t>(part * static_cast<double>(times.size() - 1))];
  };
  std::printf("{\"requests\": %zu, \"median\": %.1f, \"p99\": %.1f, \"longest\": %.1f}\n", times.size(),
              at(0.5), at(0.99), times.back());
  return 0;
}
