// SPDX-License-Identifier: Apache-2.0
// From an edge to the message that tells of it, through a node and a driver and through a bare chain, in
// turn. Each line of its output is a sample: the side and ns. ROUNDS is even.
//   coupler_bench_edges wire CHIP WIRES ROUNDS
// In the test kernel, from the kernel's stamps of lines 1 and 2, and of line 4, whose point is stamped. Of
// that also "stamp" with three figures: the kernel's stamp of an edge, which is between the first two, less
// the driver's; and the uncertainty of that. If one was not within it, the exit status is 1.
//   coupler_bench_edges coil NODE_PORT BARE_PORT ROUNDS
// A node with --sim, whose input follows its coil, from the request that writes it.
#include <coupler_driver/BoolStamped.h>
#include <std_msgs/Bool.h>
#include <sys/socket.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "test/bench/time/heard.hpp"
#include "test/bench/time/known_edges.hpp"

namespace coupler::bench {
namespace {

using coupler_driver::BoolStamped;
using std_msgs::Bool;
/// Makes an edge; the function that it returns says when it was, or nothing if it does not know. That is
/// called when the message has come.
using MakeEdge = std::function<std::function<std::optional<std::int64_t>()>(bool level)>;

constexpr int repetitions = 5;
/// A simulated chip merges edges that are nearer to each other.
constexpr std::chrono::milliseconds pause(8);

void measure(const char* side, int rounds, const MakeEdge& make_edge, Heard<Bool>& heard) {
  for (int i = 0; i < rounds; ++i) {
    const bool level = i % 2 == 0;  // the last one is low
    std::this_thread::sleep_for(pause);
    const auto when = make_edge(level);
    const auto told = heard.wait_for([&](const Bool& message) { return (message.data != 0) == level; });
    if (const auto edge = when()) std::printf("%s %lld\n", side, static_cast<long long>(told.at - *edge));
  }
}

class Sides {
 public:
  Sides() : spinner_(1) { spinner_.start(); }

  void measure_in_turn(int rounds, const MakeEdge& for_node, const MakeEdge& for_bare,
                       const std::function<void()>& measure_more = {}) {
    node_.wait_for([](const Bool& message) { return message.data == 0; });
    bare_.connect();
    for (int run = 0; run < repetitions; ++run) {
      measure("node", rounds, for_node, node_);
      measure("bare", rounds, for_bare, bare_);
      if (measure_more) measure_more();
    }
  }

 private:
  ros::NodeHandle handle_;
  Heard<Bool> node_{handle_, "plant/input"};
  Heard<Bool> bare_{handle_, "bare/input"};
  ros::AsyncSpinner spinner_;
};

struct Stamps {
  int right = 0;
  int wrong = 0;
};

void measure_stamped(int rounds, const KnownEdges& edges, const Wire& wire, Heard<BoolStamped>& heard,
                     Stamps& stamps) {
  heard.connect();
  for (int i = 0; i < rounds; ++i) {
    const bool level = i % 2 == 0;
    std::this_thread::sleep_for(pause);
    edges.pull(wire, level);
    const auto told = heard.wait_for([&](const BoolStamped& one) { return (one.value != 0) == level; });
    const WallOffset wall = wall_offset();
    const auto stamp = static_cast<std::int64_t>(told.message->header.stamp.toNSec()) - wall.offset;
    const auto uncertainty = static_cast<std::int64_t>(told.message->uncertainty * 1e9) + wall.error;
    const auto edge = edges.stamp();
    if (!edge) continue;
    std::printf("stamped %lld\n", static_cast<long long>(told.at - edge->earliest));
    const bool is_right = edge->earliest <= stamp + uncertainty && edge->latest >= stamp - uncertainty;
    ++(is_right ? stamps.right : stamps.wrong);
    std::printf("stamp %lld %lld %lld\n", static_cast<long long>(edge->earliest - stamp),
                static_cast<long long>(edge->latest - stamp), static_cast<long long>(uncertainty));
  }
}

bool on_wires(const char* chip, const std::string& wires, int rounds) {
  const Wire of_node(wires + "/sim_gpio1");
  const Wire of_bare(wires + "/sim_gpio2");
  const Wire of_stamped(wires + "/sim_gpio4");
  const KnownEdges edges(chip, wires);
  const auto pull = [&](const Wire& wire) -> MakeEdge {
    return [&](bool level) {
      edges.pull(wire, level);
      return [&]() -> std::optional<std::int64_t> {
        const auto stamp = edges.stamp();
        return stamp ? std::optional(stamp->earliest) : std::nullopt;
      };
    };
  };
  Sides sides;
  ros::NodeHandle handle;
  Heard<BoolStamped> stamped(handle, "plant/stamped_input/stamped");
  Stamps stamps;
  sides.measure_in_turn(rounds, pull(of_node), pull(of_bare),
                        [&] { measure_stamped(rounds, edges, of_stamped, stamped, stamps); });
  return stamps.right > 0 && stamps.wrong == 0;
}

void of_a_coil(std::uint16_t node_port, std::uint16_t bare_port, int rounds) {
  LockStepClient client(node_port);
  const LockStepClient bare(bare_port);
  const auto begun_now = [] { return [begun = std::optional(now(CLOCK_MONOTONIC))] { return begun; }; };
  Sides().measure_in_turn(
      rounds,
      [&](bool level) {
        const auto begun = begun_now();
        const Adu both = adu({5, 0, 0, static_cast<std::uint8_t>(level ? 0xFF : 0), 0});
        client.ask_and_wait({both, both});
        return begun;
      },
      [&](bool level) {
        const auto begun = begun_now();
        const char byte = level ? 1 : 0;
        if (::send(bare.socket(), &byte, 1, MSG_NOSIGNAL) != 1) give_up("the bare chain ended");
        return begun;
      });
}

}  // namespace
}  // namespace coupler::bench

int main(int argc, char** argv) {
  using namespace coupler::bench;
  ros::init(argc, argv, "edges", ros::init_options::NoSigintHandler);
  const std::string_view how = argc == 5 ? argv[1] : "";
  const auto port = [&](int i) { return static_cast<std::uint16_t>(std::atoi(argv[i])); };
  const int rounds = argc == 5 ? std::atoi(argv[4]) : 0;
  if (rounds % 2 != 0) return 2;
  if (how == "wire") return on_wires(argv[2], argv[3], rounds) ? 0 : 1;
  if (how != "coil") return 2;
  of_a_coil(port(2), port(3), rounds);
  return 0;
}
