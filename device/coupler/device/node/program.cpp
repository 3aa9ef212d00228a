// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/program.hpp"

#include <cstdlib>

#include "coupler/base/standard_files.hpp"
#include "coupler/device/node/serve.hpp"

namespace coupler::device {

namespace {

int run(const Map& map, Hooks* hooks, int argc, char** argv) {
  open_standard_files();
  const auto options = parse_options(argc, argv, MapSource::built_in);
  if (const int* status = std::get_if<int>(&options)) return *status;
  StderrLog log(std::getenv("JOURNAL_STREAM"));
  return serve(map, std::get<Options>(options), log, {}, hooks);
}

}  // namespace

int main_with(const Map& map, int argc, char** argv) { return run(map, nullptr, argc, argv); }

int main_with(const Map& map, Hooks& hooks, int argc, char** argv) { return run(map, &hooks, argc, argv); }

}  // namespace coupler::device
