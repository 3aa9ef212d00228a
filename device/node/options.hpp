// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

namespace coupler::node {

/// How a node is called.
struct Options {
  std::string map;                    ///< a file; programs with a built-in map have none
  std::string listen;                 ///< empty: every interface, loopback when simulated
  std::optional<std::uint16_t> port;  ///< default: the map's
  bool simulated = false;
};

enum class MapSource { argument, built_in };

/// The options, or the exit status if there is nothing more to do (0 after --help, 2 after a wrong call,
/// which is explained on stderr).
std::variant<Options, int> parse_options(int argc, char** argv, MapSource source);

}  // namespace coupler::node
