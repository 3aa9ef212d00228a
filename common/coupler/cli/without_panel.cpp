// SPDX-License-Identifier: Apache-2.0
// In place of panel.cpp in a build without cpp-httplib or libmodbus.
#include "coupler/cli/commands.hpp"

namespace coupler::cli {

void add_panel(Program& program, Exit& exit) {
  auto command = program.add_command(
      "panel", "A live page of a device (not in this build: no cpp-httplib or libmodbus).");
  command.allow_extras();
  command.callback([&exit] {
    exit = complain("panel", failed, "this program was built without cpp-httplib or libmodbus",
                    "install libcpp-httplib-dev and libmodbus-dev and build it again");
  });
}

}  // namespace coupler::cli
