// SPDX-License-Identifier: Apache-2.0
// `coupler probe` of a build without libmodbus.
#include <fmt/format.h>

#include "common/cli/commands.hpp"

namespace coupler::cli {

void add_probe(Program& program, Exit& exit) {
  auto command =
      program.add_command("probe", "Find out what a device answers to (not in this build: no libmodbus).");
  command.allow_extras();
  command.callback([&exit] {
    fmt::print(stderr,
               "coupler probe: error: this program was built without libmodbus and cannot ask a device; "
               "install libmodbus-dev and build it again\n");
    exit = failed;
  });
}

}  // namespace coupler::cli
