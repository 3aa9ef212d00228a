// SPDX-License-Identifier: Apache-2.0
// coupler-node: serves a map that it reads at the start, and again at SIGHUP.
#include <cstdlib>

#include "coupler/base/standard_files.hpp"
#include "coupler/device/node/map_input.hpp"
#include "coupler/device/node/reload.hpp"
#include "coupler/device/node/serve.hpp"

int main(int argc, char** argv) {
  using namespace coupler::device;
  coupler::open_standard_files();
  const auto options = parse_options(argc, argv, MapSource::argument);
  if (const int* status = std::get_if<int>(&options)) return *status;

  StderrLog log(std::getenv("JOURNAL_STREAM"));
  if (const auto node = std::get<Options>(options).reload; node != 0)
    return ask_to_reload(static_cast<pid_t>(node), log);
  const MapInput input(std::get<Options>(options).map, log);
  const auto map = read_first(input.first());
  if (!map) {
    if (!map.error().empty()) log.fail(map.error());
    return Refusal::map_is_wrong;
  }
  return serve((*map)->map(), std::get<Options>(options), log, input.again(), nullptr);
}
