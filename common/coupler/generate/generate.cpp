// SPDX-License-Identifier: Apache-2.0
#include "coupler/generate/generate.hpp"

#include "coupler/generate/client.hpp"
#include "coupler/generate/hooks.hpp"
#include "coupler/generate/programs.hpp"
#include "coupler/generate/table.hpp"

namespace coupler::generate {

std::vector<File> generate(const Map& map, const Stamp& stamp) {
  return {{stamp.name + "_client.cpp", client_source(map, stamp)},
          {stamp.name + "_client.hpp", client_header(map, stamp)},
          {stamp.name + "_driver.cpp", driver_program(stamp)},
          {stamp.name + "_hooks.hpp", node_hooks(map, stamp)},
          {stamp.name + "_map.cpp", table_source(map, stamp)},
          {stamp.name + "_map.hpp", table_header(map, stamp)},
          {stamp.name + "_node.cpp", node_program(stamp)}};
}

}  // namespace coupler::generate
