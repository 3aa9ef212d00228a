// SPDX-License-Identifier: Apache-2.0
// MAP, as every command takes it: a YAML or JSON file, - for standard input, or tcp://HOST[:PORT][/UNIT] or
// tls://… for the map that a node serves.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "coupler/cli/commands.hpp"
#include "coupler/cli/tls_argument.hpp"
#include "coupler/map/loader/load.hpp"
#include "coupler/map/node_address.hpp"

namespace coupler::cli {

/// The description of the argument in a help text.
constexpr auto map_help =
    "YAML or JSON file; - is standard input; tcp:// or tls://HOST[:PORT][/UNIT] is a node";

/// The same for a command that finds out the map of a device.
constexpr auto map_or_device_help =
    "YAML or JSON file; - is standard input; HOST[:PORT][/UNIT] or /dev/ttyUSB0[/UNIT] is a device, whose "
    "map is "
    "found out";

struct MapArgument {
  LoadResult loaded;
  Exit exit = ok;                              ///< how the command ends if there is no map
  std::optional<NodeAddress> node{};           ///< where it was found, if on a node
  Tls tls{};                                   ///< by which
  std::shared_ptr<const std::string> place{};  ///< of which `node` is a view, if not of the argument

  /// To be called if there is one. From a node, its connection is the one that was given.
  Map map() const;
};

/// Every problem is in the diagnostics. With `renew` a command gives addresses to the new points of a file,
/// and its lock is written if that changes; with `exact` nothing is written, and a lock that is not up to
/// date is an error. A lock that cannot be written is an error, too. A node's map has no lock. `tls`, for a
/// node, outlives the result.
MapArgument get_map(const std::string& argument, const TlsTexts& tls, LockUse use = LockUse::read);

/// The same, or HOST[:PORT][/UNIT] or a serial port without any prefix, unless there is a file of that name:
/// the map of a device that serves none is found out. `command` says on standard error how.
MapArgument get_map_or_find(std::string_view command, const std::string& argument, const TlsTexts& tls);

/// The same as get_map(), or REVISION:PATH of git, unless there is a file of that name: `git show` is run,
/// and what it says is a diagnostic.
MapArgument get_version(const std::string& argument, const TlsTexts& tls);

}  // namespace coupler::cli
