// SPDX-License-Identifier: Apache-2.0
#include "coupler/generate/generate.hpp"

#include "coupler/generate/client.hpp"
#include "coupler/generate/hooks.hpp"
#include "coupler/generate/node_core.hpp"
#include "coupler/generate/programs.hpp"
#include "coupler/generate/table.hpp"

namespace coupler::generate {

std::vector<File> generate(const Map& map, const Provenance& provenance) {
  return {{provenance.name + "_client.cpp", client_source(map, provenance)},
          {provenance.name + "_client.hpp", client_header(map, provenance)},
          {provenance.name + "_core.hpp", node_core(map, provenance)},
          {provenance.name + "_driver.cpp", driver_program(provenance)},
          {provenance.name + "_hooks.hpp", node_hooks(map, provenance)},
          {provenance.name + "_map.cpp", table_source(map, provenance)},
          {provenance.name + "_map.hpp", table_header(map, provenance)},
          {provenance.name + "_node.cpp", node_program(provenance)}};
}

}  // namespace coupler::generate
