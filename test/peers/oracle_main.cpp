// SPDX-License-Identifier: Apache-2.0
// Asks a node and libmodbus's own server the same valid requests; their replies must be equal, byte for byte.
//   coupler_oracle --map     prints the map that the node is to serve
//   coupler_oracle PORT      compares the node on that loopback port
#include <cstdio>
#include <cstdlib>
#include <string>

#include "test/peers/oracle.hpp"

namespace {

void print(const char* who, const coupler::oracle::Bytes& bytes) {
  std::printf("  %s:", who);
  for (const unsigned byte : bytes) std::printf(" %02X", byte);
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  using namespace coupler::oracle;
  const Layout layout;
  const std::string argument = argc == 2 ? argv[1] : "";
  if (argument == "--map") return std::puts(layout.map().c_str()) < 0 ? 3 : 0;
  const long port = std::strtol(argument.c_str(), nullptr, 10);
  if (port < 1 || port > 65535) {
    std::fprintf(stderr, "usage: coupler_oracle --map | PORT\n");
    return 2;
  }

  Oracle oracle(layout);
  Peer node(static_cast<std::uint16_t>(port));
  if (!node.is_connected()) {
    std::printf("FAILED: nothing listens on port %ld\n", port);
    return 3;
  }
  int exceptions = 0;
  const auto asked = requests(layout, 1500);
  for (const Bytes& request : asked) {
    const Bytes wanted = oracle.ask(request);
    const Bytes got = node.ask(request);
    if (got != wanted || wanted.empty()) {
      std::printf("FAILED: the node's reply is not libmodbus's\n");
      print("request", request);
      print("libmodbus", wanted);
      print("node", got);
      return 1;
    }
    if ((wanted[7] & 0x80) != 0) ++exceptions;
  }
  std::printf(
      "ok: %zu valid requests get the replies that libmodbus gives, byte for byte (%d of them exceptions)\n",
      asked.size(), exceptions);
  return 0;
}
