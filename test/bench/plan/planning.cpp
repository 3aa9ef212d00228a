// SPDX-License-Identifier: Apache-2.0
// How long it takes to plan a map of 10,000 points that are scattered over the four tables.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <random>

#include "coupler/map/owned_map.hpp"
#include "coupler/plan/cost.hpp"

namespace {

using namespace coupler;

constexpr std::size_t points_of_a_table = 2500;

MapPtr scattered() {
  auto owned = std::make_shared<OwnedMap>();
  std::mt19937 random(1);  // NOLINT(cert-msc51-cpp): the same map in every run
  std::vector<Point> points;
  std::vector<std::uint16_t> addresses(65536);
  for (std::size_t i = 0; i < addresses.size(); ++i) addresses[i] = static_cast<std::uint16_t>(i);
  for (const Table table : tables) {
    std::shuffle(addresses.begin(), addresses.end(), random);
    for (std::size_t i = 0; i < points_of_a_table; ++i) {
      Point point;
      point.name = owned->keep(fmt::format("{}_{}", to_string(table), addresses[i]));
      point.table = table;
      point.address = addresses[i];
      if (!holds_bits(table)) point.format.type = codec::Type::UINT;
      if (i % 4 == 0) point.host.rate = 1;
      points.push_back(point);
    }
  }
  Map head;
  head.name = "scattered";
  head.polling.discrete_continuous = head.polling.register_continuous = true;
  owned->finish(head, points, {});
  return owned;
}

/// The median of 21 runs, in ms.
template <class Work>
double median_time(Work&& work) {
  std::vector<double> times;
  for (int i = 0; i < 21; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    times.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
  }
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

}  // namespace

int main() {
  const MapPtr owned = scattered();
  const Map& map = owned->map();
  std::size_t requests = 0;
  const double whole = median_time([&] {
    requests = 0;
    for (const plan::GroupPlan& group : plan::make_read_plan(map)) requests += group.spans.size();
  });
  const plan::Planner planner(map);
  std::vector<std::uint32_t> every_second;
  for (const std::uint32_t point : planner.groups().front().points)
    if (point % 2 == 0) every_second.push_back(point);
  std::size_t fewer = 0;
  const double again = median_time([&] { fewer = planner.plan(every_second).size(); });
  const double compared = median_time([&] { plan::compare_strategies(map, {}); });
  fmt::print("{} scattered points, two rates: {} requests, planned in {:.2f} ms\n", map.points.size(),
             requests, whole);
  fmt::print("{} of them wanted: {} requests, planned anew in {:.2f} ms\n", every_second.size(), fewer,
             again);
  fmt::print("three strategies compared in {:.2f} ms\n", compared);
}
