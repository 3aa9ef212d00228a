// SPDX-License-Identifier: Apache-2.0
// A generated client that tells each value of coil c0 and when it was true, in ns of CLOCK_MONOTONIC, plus or
// minus:
//   told_changes PORT     of a node on this machine that serves peers.yaml; ends with its input
#include <cstdio>
#include <cstdlib>

#include "peers_client.hpp"

namespace {

long long nanoseconds(coupler::host::Duration time) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(time).count();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  coupler::client::Options options;
  options.address = "127.0.0.1";
  options.port = static_cast<std::uint16_t>(std::atoi(argv[1]));
  coupler::maps::peers::Client node(options);
  node.c0.on_stamped_change([](bool level, coupler::host::Stamp stamp) {
    std::printf("%d %lld %lld\n", level ? 1 : 0, nanoseconds(stamp.at.time_since_epoch()),
                nanoseconds(stamp.uncertainty));
    std::fflush(stdout);
  });
  node.connect();
  while (std::getchar() != EOF) continue;
}
