// SPDX-License-Identifier: Apache-2.0
// coupler-node: serves a map that it reads at the start, and again at SIGHUP.
#include <cstdio>

#include "common/map/loader/load.hpp"
#include "device/node/serve.hpp"

int main(int argc, char** argv) {
  using namespace coupler;
  const auto options = node::parse_options(argc, argv, node::MapSource::argument);
  if (const int* status = std::get_if<int>(&options)) return *status;

  const std::string& file = std::get<node::Options>(options).map;
  const LoadResult loaded = load_map_file(file);
  for (const Diagnostic& diagnostic : loaded.diagnostics)
    std::fprintf(stderr, "%s\n", to_string(diagnostic).c_str());
  if (loaded.map == nullptr) return 1;
  const auto read_again = [&](node::Log& log) {
    const LoadResult again = load_map_file(file);
    for (const Diagnostic& diagnostic : again.diagnostics) log.fail(to_string(diagnostic));
    return again.map;
  };
  return node::serve(loaded.map->map(), std::get<node::Options>(options), read_again);
}
