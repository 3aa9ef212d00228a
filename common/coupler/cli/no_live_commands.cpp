// SPDX-License-Identifier: Apache-2.0
// The commands that ask a device, in a build without libmodbus.
#include <fmt/format.h>

#include "coupler/cli/commands.hpp"

namespace coupler::cli {
namespace {

void add_absent(Program& program, Exit& exit, const std::string& name, const std::string& what) {
  auto command = program.add_command(name, what + " (not in this build: no libmodbus).");
  command.allow_extras();
  command.callback([&exit, name] {
    fmt::print(stderr,
               "coupler {}: error: this program was built without libmodbus and cannot ask a device; "
               "install libmodbus-dev and build it again\n",
               name);
    exit = failed;
  });
}

}  // namespace

void add_probe(Program& program, Exit& exit) {
  add_absent(program, exit, "probe", "Find out what a device answers to");
}

void add_status(Program& program, Exit& exit) {
  add_absent(program, exit, "status", "Show what a node says of itself");
}

}  // namespace coupler::cli
