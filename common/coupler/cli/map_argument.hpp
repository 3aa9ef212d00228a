// SPDX-License-Identifier: Apache-2.0
// MAP, as every command takes it: a YAML or JSON file, - for standard input, or tcp://HOST[:PORT][/UNIT] or
// tls://… for the map that a node serves.
#pragma once

#include <optional>
#include <string>

#include "coupler/cli/commands.hpp"
#include "coupler/cli/tls_argument.hpp"
#include "coupler/map/loader/load.hpp"
#include "coupler/map/node_address.hpp"

namespace coupler::cli {

/// What a help text calls it.
constexpr auto map_help = "YAML or JSON file; - is standard input; tcp://HOST[:PORT][/UNIT] is a node";

struct MapArgument {
  LoadResult loaded;
  Exit exit = ok;                     ///< how the command ends if there is no map
  std::optional<NodeAddress> node{};  ///< where it was found, if on a node
  Tls tls{};                          ///< by which

  /// To be called if there is one. From a node, its connection is the one that was given.
  Map map() const;
};

/// Every problem is in the diagnostics. With `renew` a command gives addresses to the new points of a file,
/// and its lock is written if that changes; with `exact` nothing is written, and a lock that is not up to
/// date is an error. A lock that cannot be written is an error, too. A node's map has no lock. `tls`, for a
/// node, outlives the result.
MapArgument get_map(const std::string& argument, const TlsTexts& tls, LockUse use = LockUse::read);

/// The same, or REVISION:PATH of git, unless there is a file of that name: `git show` is run, and what it
/// says is a diagnostic.
MapArgument get_version(const std::string& argument, const TlsTexts& tls);

}  // namespace coupler::cli
