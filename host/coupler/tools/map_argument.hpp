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
  std::optional<NodeAddress> node{};           ///< the device that the argument names; nullopt: a file
  Tls tls{};                                   ///< the TLS settings for that device
  std::shared_ptr<const std::string> place{};  ///< the text that `node` views; null: it views the argument

  /// Returns the map, which must have been loaded. That of a device has the connection that was given.
  Map map() const;
};

MapArgument no_map(const std::string& argument, const Failure& why);

/// Returns whether an argument can be a device instead of a map: an address such as tcp://HOST, or a serial
/// port. If there is no such file, any name can be one, unless it is "-", has the ending of a map's file, or
/// has a slash and is neither in /dev nor HOST/UNIT.
bool can_be_a_device(const std::string& argument);

/// Loads a map; every problem is in the diagnostics. With LockUse::renew, the new points of a file get
/// addresses, and its lock is written if it changes. With LockUse::exact, nothing is written, and a lock that
/// is not up to date is an error. A lock that cannot be written is an error, too. The map of a node has no
/// lock. `tls` is for a node, and must outlive the result.
MapArgument get_map(const std::string& argument, const TlsTexts& tls, LockUse use = LockUse::read);

/// Does the same with LockUse::read, and also takes REVISION:PATH of git, unless there is a file of that
/// name. It runs `git show`, and an error of git becomes a diagnostic.
MapArgument get_version(const std::string& argument, const TlsTexts& tls);

}  // namespace coupler::tools
