// SPDX-License-Identifier: Apache-2.0
// coupler-node: serves a map that it reads at the start, and again at SIGHUP.
#include <cstdlib>

#include "common/map/loader/load.hpp"
#include "device/node/serve.hpp"

int main(int argc, char** argv) {
  using namespace coupler;
  const auto options = node::parse_options(argc, argv, node::MapSource::argument);
  if (const int* status = std::get_if<int>(&options)) return *status;

  node::StderrLog log(std::getenv("JOURNAL_STREAM"));
  const auto read = [&] {
    const LoadResult loaded = load_map_file(std::get<node::Options>(options).map);
    for (const Diagnostic& diagnostic : loaded.diagnostics) log.tell(diagnostic);
    return loaded.map;
  };
  const MapPtr map = read();
  if (map == nullptr) return 1;
  const bool once = std::get<node::Options>(options).map == "-";
  return node::serve(map->map(), std::get<node::Options>(options), log, once ? node::ReadAgain() : read,
                     nullptr);
}
