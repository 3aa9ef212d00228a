// SPDX-License-Identifier: Apache-2.0
// coupler: what a person or a build does with maps at the command line.
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "coupler/base/ending_signals.hpp"
#include "coupler/base/standard_files.hpp"
#include "coupler/base/version.hpp"
#include "coupler/base/what_failed.hpp"
#include "coupler/map/nearest.hpp"
#include "coupler/tools/commands.hpp"

static_assert(coupler::version == COUPLER_VERSION, "coupler/base/version.hpp and CMakeLists.txt differ");

int main(int argc, char** argv) {
  using namespace coupler::tools;
  coupler::open_standard_files();
  Program program{"OpenCoupler: makes both sides of a Modbus coupler from one map.", "coupler"};
  program.version("coupler " COUPLER_VERSION);
  program.propose(coupler::nearest);
  program.footer("Example:\n  coupler check device.yaml\n`coupler COMMAND --help` explains one command.");
  program.explain([](const std::string& command, const std::string& what) {
    return command + ": error: " + what + "; see `" + command + " --help`\n";
  });

  auto exit = ok;
  for (const auto add :
       {add_certificates, add_check, add_diff, add_dump, add_export, add_fetch, add_generate, add_import,
        add_init, add_panel, add_pin, add_plan, add_probe, add_record, add_schema, add_status})
    add(program, exit);
  std::optional<int> done;
  try {
    done = program.parse(argc, argv);
  } catch (const std::exception& error) {  // no thread or no memory is left
    std::fputs(fmt::format("coupler: error: {}\n", coupler::what_failed(error)).c_str(), stderr);
    return failed;
  }
  int code = done.value_or(exit);
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    const std::string line =
        fmt::format("coupler: error: cannot write standard output: {}; what is there is not whole\n",
                    std::strerror(errno));
    std::fputs(line.c_str(), stderr);
    code = code == ok ? bad_call : code;
  }
  return coupler::end_with(code);
}
