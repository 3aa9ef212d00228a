// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coupler/generate/provenance.hpp"
#include "coupler/map/map.hpp"

namespace coupler::generate {

struct File {
  std::string name;  ///< without a folder
  std::string content;
};

/// All that is made of a map, sorted by name.
std::vector<File> generate(const Map& map, const Provenance& provenance);

}  // namespace coupler::generate
