// SPDX-License-Identifier: Apache-2.0
// The C++ that is made of a map: one function for each file.
#pragma once

#include <string>
#include <vector>

#include "coupler/map/map.hpp"

namespace coupler::generate {

/// The origin of generated files, as they show it. It has no path and no time, so that the same map gives the
/// same bytes anywhere.
struct Provenance {
  std::string name;     ///< NAME in NAME_map.cpp and coupler::maps::NAME; is_identifier() holds
  std::string source;   ///< the map's file name, without its folder
  std::string version;  ///< of the program that generates
};

struct File {
  std::string name;  ///< without a folder
  std::string content;
};

/// All of them, sorted by name.
std::vector<File> generate(const Map& map, const Provenance& provenance);

/// NAME_map.hpp: declares coupler::maps::NAME::map.
std::string table_header(const Map& map, const Provenance& provenance);

/// NAME_map.cpp: everything the map has, as constant data.
std::string table_source(const Map& map, const Provenance& provenance);

/// NAME_client.hpp: the class coupler::maps::NAME::Client, a member for each point.
std::string client_header(const Map& map, const Provenance& provenance);

/// NAME_client.cpp: its constructor.
std::string client_source(const Map& map, const Provenance& provenance);

/// NAME_hooks.hpp: the class coupler::maps::NAME::NodeHooks. A firmware derives from it to put its own code
/// behind the points.
std::string node_hooks(const Map& map, const Provenance& provenance);

/// NAME_core.hpp: the class coupler::maps::NAME::NodeCore, the node of a microcontroller, in static memory of
/// the size that the map needs.
std::string node_core(const Map& map, const Provenance& provenance);

/// NAME_node.cpp: the main of a node that serves coupler::maps::NAME::map.
std::string node_program(const Provenance& provenance);

/// NAME_driver.cpp: the main of the ROS driver for it.
std::string driver_program(const Provenance& provenance);

}  // namespace coupler::generate
