// SPDX-License-Identifier: Apache-2.0
#include "device/node/program.hpp"

#include "device/node/serve.hpp"

namespace coupler::node {

int main_with(const Map& map, int argc, char** argv) {
  const auto options = parse_options(argc, argv, MapSource::built_in);
  if (const int* status = std::get_if<int>(&options)) return *status;
  return serve(map, std::get<Options>(options));
}

}  // namespace coupler::node
