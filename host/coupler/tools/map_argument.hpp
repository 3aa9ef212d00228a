// SPDX-License-Identifier: Apache-2.0
// MAP, as every command takes it: a YAML or JSON file, - for standard input, or the place of a device, for
// the map that a node serves or that is found out.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "coupler/map/loader/load.hpp"
#include "coupler/tools/commands.hpp"
#include "coupler/tools/place_argument.hpp"

namespace coupler::tools {

/// The description of the argument in a help text.
constexpr auto map_help =
    "YAML or JSON file; - is standard input; HOST[:PORT][/UNIT] or /dev/ttyUSB0[/UNIT] is a node that serves "
    "its map";

/// The map of a device.
struct FoundMap {
  MapPtr map;
  Connection where;  ///< where the device has answered: a view of the place or of the map
};

/// How the map of a device is got.
using FindMap = std::function<tl::expected<FoundMap, Failure>(const Place& place)>;

struct MapArgument {
  LoadResult loaded;
  Exit exit = ok;                              ///< how the command ends if there is no map
  std::optional<NodeAddress> node{};           ///< the device that the argument names; nullopt: a file
  Tls tls{};                                   ///< the TLS settings for that device
  std::shared_ptr<const std::string> place{};  ///< the text that `node` views

  /// Returns the map, which must have been loaded. That of a device has the connection that was given.
  Map map() const;
};

/// Loads a map; every problem is in the diagnostics. With LockUse::renew, the new points of a file get
/// addresses, and its lock is written if it changes. With LockUse::exact, nothing is written, and a lock that
/// is not up to date is an error. A lock that cannot be written is an error, too. The map of a node has no
/// lock. `tls` is for a device, and must outlive the result. `find` gets the map of a device; without it,
/// that has to be a node that serves one.
MapArgument get_map(const std::string& argument, const TlsTexts& tls, LockUse use = LockUse::read,
                    const FindMap& find = {});

/// Does the same with LockUse::read, and also takes REVISION:PATH of git, unless there is a file of that
/// name or it is HOST:PORT. It runs `git show`, and an error of git becomes a diagnostic.
MapArgument get_version(const std::string& argument, const TlsTexts& tls);

}  // namespace coupler::tools
