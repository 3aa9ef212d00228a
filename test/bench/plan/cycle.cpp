// SPDX-License-Identifier: Apache-2.0
// Runs the plan of a map against a device and compares the time with the prediction:
//   coupler_bench_cycle MAP PORT
// The round trip is measured with the smallest of requests, in turn with the cycles. Loopback has no wire on
// which bytes take their time, so the prediction is made without it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <string>

#include "coupler/host/modbus/make_links.hpp"
#include "coupler/map/loader/load.hpp"
#include "coupler/plan/cost.hpp"

namespace {

using namespace coupler;
using Nanoseconds = std::chrono::nanoseconds;

class Reader {
 public:
  explicit Reader(const Connection& connection) : link_(host::make_link(connection)) {
    check(link_.connect());
  }

  /// How long the reply takes.
  Nanoseconds read(Table table, modbus::Range range) {
    const auto begin = std::chrono::steady_clock::now();
    check(link_.read(table, range, values_.data()));
    return std::chrono::steady_clock::now() - begin;
  }

 private:
  static void check(const host::Result<>& result) {
    if (result) return;
    fmt::print(stderr, "coupler_bench_cycle: {}\n", to_string(result.error()));
    std::exit(3);
  }
  host::Link link_;
  std::array<std::uint16_t, modbus::max_read_bits> values_{};
};

Nanoseconds median(std::vector<Nanoseconds> times) {
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

double microseconds(Nanoseconds time) { return std::chrono::duration<double, std::micro>(time).count(); }

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: coupler_bench_cycle MAP PORT\n");
    return 2;
  }
  const LoadResult loaded = load_map_file(argv[1]);
  if (!loaded.map) return 1;
  Connection connection;
  connection.address = "127.0.0.1";
  connection.port = static_cast<std::uint16_t>(std::atoi(argv[2]));
  Reader reader(connection);
  const plan::GroupPlan group = plan::make_read_plan(loaded.map->map()).front();
  const plan::ReadSpan& first = group.spans.front();
  std::vector<Nanoseconds> small;
  std::vector<Nanoseconds> cycles;
  for (int i = 0; i < 1001; ++i) {
    Nanoseconds cycle{0};
    for (const plan::ReadSpan& span : group.spans) cycle += reader.read(span.table, span.range);
    cycles.push_back(cycle);
    small.push_back(reader.read(first.table, modbus::Range::of(first.range.start(), 1)));
  }
  plan::NetworkTiming timing;
  timing.round_trip = median(small);
  timing.byte_time = Nanoseconds(0);
  const plan::Cost cost = cost_of(group, timing);
  const Nanoseconds measured = median(cycles);
  fmt::print(
      "{} requests, {} registers, {} bits; round trip {:.1f} µs: predicted {:.0f} µs, measured {:.0f} µs, "
      "ratio {:.2f}\n",
      cost.requests, cost.registers, cost.bits, microseconds(timing.round_trip), microseconds(cost.time),
      microseconds(measured), microseconds(measured) / microseconds(cost.time));
}
