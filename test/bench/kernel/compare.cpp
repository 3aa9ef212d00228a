// SPDX-License-Identifier: Apache-2.0
// From a wire to a client and back: the node, the floor server and bare ioctls in turn, on lines of one chip
// of their own, the median of several runs of each.
#include <fmt/format.h>
#include <linux/gpio.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "test/bench/kernel/line.hpp"
#include "test/bench/kernel/wire.hpp"
#include "test/bench/node/lock_step_client.hpp"

namespace coupler::bench {
namespace {

constexpr int repetitions = 5;
enum Side : std::size_t { node, floor, bare };

/// Takes one step at a level; a level that is not there in the end is no result but a failure.
using Step = std::function<void(bool level)>;

struct Comparison {
  const char* title;
  std::array<Step, 3> sides;
};

struct Figures {
  double p50;
  double p99;  ///< both in µs
};

Figures run(const Step& step, std::size_t rounds) {
  std::vector<double> each(rounds);
  bool level = false;
  for (double& took : each) {
    level = !level;
    const auto start = LockStepClient::Clock::now();
    step(level);
    took = std::chrono::duration<double, std::micro>(LockStepClient::Clock::now() - start).count();
  }
  std::sort(each.begin(), each.end());
  return {each[rounds / 2], each[rounds * 99 / 100]};
}

double median(std::array<double, repetitions> values) {
  std::sort(values.begin(), values.end());
  return values[repetitions / 2];
}

void print(const Comparison& comparison, std::size_t rounds) {
  std::array<std::array<Figures, 3>, repetitions> runs{};
  for (auto& sides : runs)
    for (std::size_t side = 0; side < sides.size(); ++side) sides[side] = run(comparison.sides[side], rounds);
  const auto over_runs = [&](auto figure) {
    std::array<double, repetitions> values{};
    std::transform(runs.begin(), runs.end(), values.begin(), figure);
    return median(values);
  };
  fmt::print("{:34}", comparison.title);
  for (double Figures::*figure : {&Figures::p50, &Figures::p99}) {
    const auto of = [&](Side side) {
      return over_runs([&](const auto& sides) { return sides[side].*figure; });
    };
    const auto ratio = [&](Side side) {
      return over_runs([&](const auto& sides) { return sides[node].*figure / (sides[side].*figure); });
    };
    fmt::print("{:9.1f}{:8.1f}{:7.1f}{:8.2f}{:7.1f}", of(node), of(floor), of(bare), ratio(floor),
               ratio(bare));
  }
  fmt::print("\n");
}

/// FC 2 of discrete input 0, FC 5 of coil 0, and their only right replies at a level.
Exchange read_input(bool level) {
  return {adu({2, 0, 0, 0, 1}), adu({2, 1, static_cast<std::uint8_t>(level ? 1 : 0)})};
}
Exchange write_coil(bool level) {
  const Adu both = adu({5, 0, 0, static_cast<std::uint8_t>(level ? 0xFF : 0), 0});
  return {both, both};
}

Step reading(LockStepClient& client, const Wire& wire) {
  return [&client, &wire](bool level) {
    const Exchange exchange = read_input(level);
    wire.pull(level);
    client.ask_and_wait(exchange);
  };
}

Step writing(LockStepClient& client, const Wire& wire) {
  return [&client, &wire](bool level) {
    const Exchange exchange = write_coil(level);
    client.ask_and_wait(exchange);
    if (wire.level() != level) give_up("a write was acknowledged and the line has another level");
  };
}

void compare(const char* chip, const std::string& wires, std::size_t rounds) {
  LockStepClient to_node(1502);
  LockStepClient to_floor(1503);
  const Line input(chip, 4, GPIO_V2_LINE_FLAG_INPUT);
  const Line output(chip, 5, GPIO_V2_LINE_FLAG_OUTPUT);
  const auto wire = [&](int line) { return wires + "/sim_gpio" + std::to_string(line); };
  const Wire in_node(wire(0)), out_node(wire(1)), in_floor(wire(2)), out_floor(wire(3)), in(wire(4)),
      out(wire(5));

  const Step bare_reading = [&](bool level) {
    in.pull(level);
    if (input.read() != level) give_up("a line reads another level than its wire has");
  };
  const Step bare_writing = [&](bool level) {
    output.drive(level);
    if (out.level() != level) give_up("a line has another level than it was driven to");
  };
  fmt::print("{:34}{:^39}{:^39}\n", "", "p50 µs", "p99 µs");
  fmt::print("{:34}", "");
  for (int i = 0; i < 2; ++i)
    fmt::print("{:>9}{:>8}{:>7}{:>8}{:>7}", "node", "floor", "ioctl", "/floor", "/ioctl");
  fmt::print("\n");
  print({"wire changes -> client has read it",
         {reading(to_node, in_node), reading(to_floor, in_floor), bare_reading}},
        rounds);
  print({"client writes -> wire has changed",
         {writing(to_node, out_node), writing(to_floor, out_floor), bare_writing}},
        rounds);
}

}  // namespace
}  // namespace coupler::bench

int main(int argc, char** argv) {
  const auto rounds = argc == 4 ? std::strtoul(argv[3], nullptr, 10) : 0;
  if (rounds == 0) {
    fmt::print(stderr, "usage: {} CHIP WIRES ROUNDS, started by test/bench/kernel/run\n", argv[0]);
    return 2;
  }
  coupler::bench::compare(argv[1], argv[2], rounds);
  return 0;
}
