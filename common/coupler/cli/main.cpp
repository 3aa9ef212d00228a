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
#include "coupler/cli/commands.hpp"

static_assert(coupler::version == COUPLER_VERSION, "coupler/base/version.hpp and CMakeLists.txt differ");

int main(int argc, char** argv) {
  coupler::open_standard_files();
  coupler::cli::Program program{"OpenCoupler: makes both sides of a Modbus coupler from one map.", "coupler"};
  program.version("coupler " COUPLER_VERSION);
  program.footer("Example:\n  coupler check device.yaml\n`coupler COMMAND --help` explains one command.");
  program.explain([](const std::string& command, const std::string& what) {
    return command + ": error: " + what + "; see `" + command + " --help`\n";
  });

  auto exit = coupler::cli::ok;
  coupler::cli::add_certificates(program, exit);
  coupler::cli::add_check(program, exit);
  coupler::cli::add_diff(program, exit);
  coupler::cli::add_dump(program, exit);
  coupler::cli::add_export(program, exit);
  coupler::cli::add_generate(program, exit);
  coupler::cli::add_import(program, exit);
  coupler::cli::add_init(program, exit);
  coupler::cli::add_panel(program, exit);
  coupler::cli::add_pin(program, exit);
  coupler::cli::add_plan(program, exit);
  coupler::cli::add_probe(program, exit);
  coupler::cli::add_record(program, exit);
  coupler::cli::add_schema(program, exit);
  coupler::cli::add_status(program, exit);
  std::optional<int> done;
  try {
    done = program.parse(argc, argv);
  } catch (const std::exception& error) {  // no thread or no memory is left
    std::fputs(fmt::format("coupler: error: {}\n", coupler::what_failed(error)).c_str(), stderr);
    return coupler::cli::failed;
  }
  int code = done.value_or(exit);
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    const std::string line =
        fmt::format("coupler: error: cannot write standard output: {}; what is there is not whole\n",
                    std::strerror(errno));
    std::fputs(line.c_str(), stderr);
    code = code == coupler::cli::ok ? coupler::cli::bad_call : code;
  }
  return coupler::end_with(code);
}
