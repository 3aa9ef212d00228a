// SPDX-License-Identifier: Apache-2.0
#include "test/bench/time/known_edges.hpp"

namespace coupler::bench {
namespace {

/// ns; a tick of the kernel is longer.
constexpr std::int64_t one_tick = 1'000'000;

}  // namespace

KnownEdges::KnownEdges(const char* chip, const std::string& wires)
    : before_(wires + "/sim_gpio0"),
      behind_(wires + "/sim_gpio5"),
      first_(chip, 0, both_edges),
      last_(chip, 5, both_edges) {}

void KnownEdges::pull(const Wire& wire, bool level) const {
  before_.pull(level);
  wire.pull(level);
  behind_.pull(level);
}

std::optional<KnownEdges::Stamp> KnownEdges::stamp() const {
  const Stamp stamp{first_.next_edge().at, last_.next_edge().at};
  if (stamp.latest - stamp.earliest > one_tick) return std::nullopt;
  return stamp;
}

}  // namespace coupler::bench
