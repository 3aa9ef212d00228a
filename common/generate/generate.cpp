// SPDX-License-Identifier: Apache-2.0
#include "common/generate/generate.hpp"

#include "common/generate/programs.hpp"
#include "common/generate/table.hpp"

namespace coupler::generate {

std::vector<File> generate(const Map& map, const Stamp& stamp) {
  return {{stamp.name + "_driver.cpp", driver_program(stamp)},
          {stamp.name + "_map.cpp", table_source(map, stamp)},
          {stamp.name + "_map.hpp", table_header(map, stamp)},
          {stamp.name + "_node.cpp", node_program(stamp)}};
}

}  // namespace coupler::generate
