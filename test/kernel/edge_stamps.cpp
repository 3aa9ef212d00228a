// SPDX-License-Identifier: Apache-2.0
// What stamps.sh runs: pulls lines of a chip of the kernel with the label "plant" at known times, and
// compares the times of the changes that its lines tell.
//   edge_stamps WIRE…     the folders of the simulated wires 0 to 3
#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "coupler/device/gpio/wiring.hpp"
#include "test/device/core/fake_log.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::device {
namespace {

using namespace std::chrono_literals;
using Clock = TimePoint::clock;

constexpr std::uint16_t plain = 0;
constexpr std::uint16_t inverted = 1;
constexpr std::uint16_t counted = 2;
constexpr std::uint16_t bouncy = 3;

MapPtr plant() {
  fakes::MapBuilder builder;
  const auto wired = [&](std::string_view name, std::uint16_t address, bool active_low,
                         std::chrono::microseconds debounce) {
    builder.add(Table::discrete_inputs, name, address, codec::Type::BOOL, [=](Point& p) {
      p.line.chip = "plant";
      p.line.offset = address;
      p.line.active_low = active_low;
      p.line.debounce = debounce;
    });
  };
  wired("plain", plain, false, 0us);
  wired("inverted", inverted, true, 0us);
  wired("counted", counted, false, 0us);
  wired("bouncy", bouncy, false, 5s);  // does not settle while this program pauses
  builder.add(Table::input_registers, "count", 0, codec::Type::UINT, [](Point& p) {
    p.counter = {"counted", Edge::rising};
  });
  return builder.build();
}

struct Change {
  std::uint16_t input;
  bool level;
  TimePoint at;
};

struct Told : EdgeSink {
  void add(std::uint16_t input, const Edges& edges) override {
    if (input == counted) rising += edges.rising;
  }
  void changed(std::uint16_t input, bool level, TimePoint at) override { all.push_back({input, level, at}); }
  void lost(std::uint32_t changes) override { lost_changes += changes; }
  std::vector<Change> all;
  std::uint32_t rising = 0;
  std::uint32_t lost_changes = 0;
};

/// Between these the kernel saw an edge.
struct Window {
  TimePoint from;
  TimePoint to;
};

class Stamps {
 public:
  Stamps(std::vector<std::string> wires, std::unique_ptr<Wiring> wiring)
      : wires_(std::move(wires)), wiring_(std::move(wiring)) {}

  /// Whether all that was found is right.
  bool run() {
    for (int round = 0; round < 20; ++round)
      for (const std::uint16_t input : {plain, inverted, counted})
        for (const bool up : {true, false}) one_edge(input, up);
    for (const bool up : {true, false}) bouncing(up);
    note(told_.rising == 20, fmt::format("{} rising edges counted of 20", told_.rising));
    note(told_.lost_changes == 0, "nothing is lost");
    return good_;
  }

 private:
  /// Pulls, and waits until the kernel has an event.
  Window pull(std::uint16_t input, bool up) {
    const TimePoint from = Clock::now();
    std::ofstream(wires_[input] + "/pull") << (up ? "pull-up" : "pull-down") << std::flush;
    std::vector<pollfd> sources;
    for (const InputGroup* group : wiring_->event_sources())
      sources.push_back({group->descriptor(), POLLIN, 0});
    note(::poll(sources.data(), sources.size(), 60000) > 0, "the kernel reports an edge");
    return {from, Clock::now()};
  }

  void one_edge(std::uint16_t input, bool up) {
    const Window window = pull(input, up);
    std::this_thread::sleep_for(20ms);  // a stamp of the moment at which it is taken would be too late
    wiring_->lines().take_edges(Clock::now(), told_);
    expect_one(input, up != (input == inverted), window);
  }

  void bouncing(bool up) {
    Window last{};
    for (const bool now : {up, !up, up}) {
      last = pull(bouncy, now);
      std::this_thread::sleep_for(20ms);
      wiring_->lines().take_edges(Clock::now(), told_);
      note(told_.all.empty(), "a bouncing level is not told");
    }
    const auto next = wiring_->lines().next_change(Clock::now());
    note(next.has_value(), "the end of the period is known");
    if (next) std::this_thread::sleep_until(*next);
    wiring_->lines().take_edges(Clock::now(), told_);
    expect_one(bouncy, up, last);
  }

  void expect_one(std::uint16_t input, bool level, Window window) {
    const auto all = std::exchange(told_.all, {});
    const bool is_one = all.size() == 1 && all[0].input == input && all[0].level == level;
    note(is_one, fmt::format("input {} changed to {}, and nothing else", input, level));
    if (!is_one) return;
    const auto after = std::chrono::duration_cast<std::chrono::microseconds>(all[0].at - window.from).count();
    const auto width = std::chrono::duration_cast<std::chrono::microseconds>(window.to - window.from).count();
    note(all[0].at >= window.from && all[0].at <= window.to,
         fmt::format("input {}: stamp {} us after the pull, which the kernel reported within {} us", input,
                     after, width));
  }

  void note(bool is_right, const std::string& what) {
    if (!is_right) fmt::print("wrong: {}\n", what);
    good_ &= is_right;
  }

  std::vector<std::string> wires_;
  std::unique_ptr<Wiring> wiring_;
  Told told_;
  bool good_ = true;
};

int run(std::vector<std::string> wires) {
  const MapPtr map = plant();
  FakeLog log;
  auto prepared = prepare_wiring(map->map(), false, nullptr, false, log);
  if (!prepared) {
    fmt::print("{}\n", prepared.error());
    return 1;
  }
  const bool good = Stamps(std::move(wires), (*prepared)->take_over()).run();
  for (const std::string& line : log.lines) fmt::print("log: {}\n", line);
  return good && log.lines.empty() ? 0 : 1;
}

}  // namespace
}  // namespace coupler::device

int main(int argc, char** argv) { return argc == 5 ? coupler::device::run({argv + 1, argv + 5}) : 2; }
