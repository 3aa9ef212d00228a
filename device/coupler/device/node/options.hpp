// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "coupler/map/map.hpp"

namespace coupler::device {

/// The recording that is played instead of hardware.
struct ReplayArguments {
  std::string file;  ///< empty: nothing
  double speed = 1;
  bool loop = false;
  bool no_faults = false;
  std::string from;                 ///< empty: the beginning
  double tolerance = 0;             ///< s; 0: two periods of each point
  std::vector<std::string> points;  ///< patterns of names; empty: all are compared
};

/// How a node is called.
struct Options {
  std::string map;     ///< a file; programs with a built-in map have none, and a replay its own
  std::string listen;  ///< empty: as address_for() says
  std::optional<std::uint16_t> port;  ///< default: the map's
  std::optional<std::uint16_t> tls_port;
  bool simulated = false;
  bool realtime = false;     ///< ahead of other programs, memory locked
  std::uint32_t reload = 0;  ///< process id of a node that is to read its map again; 0: serve
  ReplayArguments replay{};
};

/// The address to listen on: the option's, the map's, loopback when simulated, otherwise (empty) every
/// interface.
std::string address_for(const Map& map, const Options& options);

enum class MapSource { argument, built_in };

/// The options, or the exit status if there is nothing more to do (0 after --help, 2 after a wrong call,
/// which is explained on stderr).
std::variant<Options, int> parse_options(int argc, char** argv, MapSource source);

}  // namespace coupler::device
