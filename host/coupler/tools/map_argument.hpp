// SPDX-License-Identifier: Apache-2.0
// MAP, as every command takes it: a YAML or JSON file, - for standard input, or tcp://HOST[:PORT][/UNIT] or
// tls://… for the map that a node serves.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "coupler/map/loader/load.hpp"
#include "coupler/map/node_address.hpp"
#include "coupler/tools/commands.hpp"
#include "coupler/tools/tls_argument.hpp"

namespace coupler::tools {

/// The description of the argument in a help text.
constexpr auto map_help =
    "YAML or JSON file; - is standard input; tcp:// or tls://HOST[:PORT][/UNIT] is a node";

struct MapArgument {
  LoadResult loaded;
  Exit exit = ok;                              ///< how the command ends if there is no map
  std::optional<NodeAddress> node{};           ///< where it was found, if on a node
  Tls tls{};                                   ///< by which
  std::shared_ptr<const std::string> place{};  ///< of which `node` is a view, if not of the argument

  /// To be called if there is one. From a node, its connection is the one that was given.
  Map map() const;
};

MapArgument no_map(const std::string& argument, const Failure& why);

/// Returns whether an argument can be a device instead of a map. A path, or the name of a map's file, is none if
/// there is no such file, unless it can be the place of a device.
bool can_be_a_device(const std::string& argument);

/// Every problem is in the diagnostics. With `renew` a command gives addresses to the new points of a file,
/// and its lock is written if that changes; with `exact` nothing is written, and a lock that is not up to
/// date is an error. A lock that cannot be written is an error, too. A node's map has no lock. `tls`, for a
/// node, outlives the result.
MapArgument get_map(const std::string& argument, const TlsTexts& tls, LockUse use = LockUse::read);

/// The same, or REVISION:PATH of git, unless there is a file of that name: `git show` is run,
/// and what it says is a diagnostic.
MapArgument get_version(const std::string& argument, const TlsTexts& tls);

}  // namespace coupler::tools
