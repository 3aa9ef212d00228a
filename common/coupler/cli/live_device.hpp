// SPDX-License-Identifier: Apache-2.0
// What the commands ask of a device. The program links coupler/host/cli, which asks over libmodbus, or
// without_libmodbus.cpp, which says that it cannot.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "coupler/cli/commands.hpp"
#include "coupler/map/map.hpp"
#include "coupler/map/owned_map.hpp"
#include "coupler/map/tls_texts.hpp"

namespace coupler::cli {

struct DeviceArgument;

/// Why there is no map, for people: what, then what to do.
struct NoLiveMap {
  Exit exit;
  std::string what;
  std::string remedy;
};

/// Asks a node once for the map that it serves, and waits for `where.timeout` at most for each answer.
/// bad_input: a foreign coupler, or a map that does not load; failed: the network, or no libmodbus.
tl::expected<MapPtr, NoLiveMap> fetch_live_map(const Connection& where);

struct FoundMap {
  MapPtr map;
  Connection where;  ///< where the device has answered, without TLS; a view of the place or of the map
};

/// A map for a device of which nothing is known but its place, as node_argument() completes it: the one that
/// it serves, else one with the preset of a coupler that its registers tell, else a draft of all that a scan
/// finds, which may take minutes. Says on standard error, as `command`, which of them it is. Never writes to
/// the device, and leaves no connection behind. bad_call: no place; bad_input: its map does not load; failed:
/// the network, or Ctrl-C.
tl::expected<FoundMap, NoLiveMap> map_of_unknown_device(std::string_view command, const std::string& place,
                                                        const TlsTexts& tls);

struct DumpOptions {
  std::vector<bool> chosen;                         ///< by point
  std::optional<std::chrono::nanoseconds> every{};  ///< nullopt: once
  bool json = false;
};

/// Reads the chosen points from the device at `map.connection` and prints them: once, or again and again
/// until SIGINT or SIGTERM. Never writes to the device. ok: every readable point was read, or the reading was
/// repeated; failed: the device is not reachable, or some points were not read.
Exit dump(const Map& map, const DumpOptions& options);

struct RecordOptions {
  std::string file;                             ///< "-": standard output
  bool csv = false;                             ///< in place of JSON lines
  std::uint64_t keep = std::uint64_t{1} << 30;  ///< bytes of all its files together
  bool sync = false;                            ///< what was recorded outlasts a loss of power
};

/// Records every change of the device at `map.connection` until SIGINT or SIGTERM. Never writes to the
/// device. failed: the device was never reached; bad_call: the file cannot be written.
Exit record(const Map& map, const RecordOptions& options);

struct PanelOptions {
  std::string listen = "127.0.0.1";  ///< IP address
  std::uint16_t port = 0;            ///< 0: any free one
  std::string name;                  ///< that browsers may call this machine besides its address; empty: none
  std::string certificate;           ///< PEM file for HTTPS; empty: HTTP
  std::string key;                   ///< its key's
  bool write = false;                ///< pages may write
  bool field = false;                ///< the field side of a simulated node (coupler/map/field_side.hpp)
};

/// Serves a live page of a device until SIGINT or SIGTERM. Writes what pages ask for only. bad_call: it
/// cannot listen there, or not with that certificate, which it looks at first. Otherwise as get_device().
Exit panel(const DeviceArgument& argument, const PanelOptions& options);

}  // namespace coupler::cli
