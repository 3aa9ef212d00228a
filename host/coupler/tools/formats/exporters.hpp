// SPDX-License-Identifier: Apache-2.0
// Exports a map as another program's file. A format is one function and its row in exporters.cpp.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/base/span.hpp"
#include "coupler/map/diagnostic.hpp"
#include "coupler/map/loader/document.hpp"
#include "coupler/map/map.hpp"

namespace coupler::formats {

/// Warns of the keys that an export leaves out, with the points concerned.
class ConversionWarnings {
 public:
  /// Warnings with the same `what` become one that lists their points. It has the place of the first.
  void add(std::string_view what, std::string_view remedy, std::string_view point = {},
           loader::Position at = {});

  /// One warning each, about `file`: "units are comments only: speed, level".
  Diagnostics diagnostics(std::string_view file) const;

 private:
  struct ConversionWarning {
    std::string what;
    std::string remedy;
    std::vector<std::string> points;
    loader::Position at;
  };
  std::vector<ConversionWarning> warnings_;
};

struct Export {
  std::string text;
  ConversionWarnings warnings;  ///< what the format cannot say
};

struct Exporter {
  std::string_view name;  ///< at the command line
  std::string_view summary;
  Export (*write)(const Map& map);  ///< the same text for the same map
  bool is_for_client;               ///< for a program that asks the device, without TLS
  Export (*write_with_statistics)(const Map& map) =
      nullptr;  ///< and of the node's statistics, if it has them
};

// A function for each format.

/// The table that `coupler import csv` reads: all that the map says of its points, with zero-based addresses
/// and explicit orders, so that the map made from it has the same fingerprint.
Export write_csv(const Map& map);

/// `modbus:` of Home Assistant's configuration.yaml: coils are switches, discrete inputs and bits binary
/// sensors, registers sensors.
Export write_home_assistant(const Map& map);

/// Structured Text (IEC 61131-3) for the PLC at the other end: structures of typed variables, arrays for the
/// registers of each request, function blocks between the two, constants for requests, addresses and names of
/// values.
Export write_structured_text(const Map& map);

/// A section [[inputs.modbus]] for Telegraf, in the plugin's "request" style: one request for each table and
/// byte order, which Telegraf splits into as many reads as it needs. Names of values are a
/// [[processors.enum]].
Export write_telegraf(const Map& map);

/// The same, with the statistics of the node that serves the map, as a measurement of their own.
Export write_telegraf_with_statistics(const Map& map);

/// A dissector in Lua for Wireshark and tshark: below their own lines for Modbus/TCP it names the map's
/// points and values, in requests and, matched by connection and transaction id, in replies.
Export write_wireshark(const Map& map);

/// wireshark.lua: the part of the dissector that no map changes.
std::string_view wireshark_body();

Span<const Exporter> exporters();

/// The exporter of that name, or nullptr.
const Exporter* find_exporter(std::string_view name);

// Functions that several exporters need.

/// Warns of what only a node or this project's driver uses: other programs that read a device have no word
/// for it.
void warn_of_node_and_driver_keys(const Map& map, ConversionWarnings& warnings);

/// Warns of points that clients without TLS may not read, and, if the program `writes`, of those that they
/// may not write.
void warn_of_rights(const Map& map, bool writes, ConversionWarnings& warnings);

/// Returns whether a client without TLS may read some point of the map.
bool lets_read_without_tls(const Map& map);

/// Warns that a program that writes the device has no tools, which never have both outputs on.
void warn_of_tools(const Map& map, ConversionWarnings& warnings);

/// Warns that the format says neither which raw values are none, unless it `writes_invalid`, or faults, nor
/// that a point has the power of ten of the scale.
void warn_of_raw_meaning(const Point& point, bool writes_invalid, ConversionWarnings& warnings);

/// Names that another program has to tell apart.
class UniqueNames {
 public:
  explicit UniqueNames(ConversionWarnings& warnings) : warnings_(warnings) {}

  /// `name`; where it is taken, the first of name_2, name_3 … that is not, and a warning about the point.
  std::string make(const std::string& name, std::string_view point);

 private:
  ConversionWarnings& warnings_;
  std::set<std::string> taken_;
};

/// Says whether the escapes in a string stand for characters or for bytes.
enum class Escapes : std::uint8_t { characters, bytes };

/// The text in double quotes, with a backslash before quotes and backslashes. `control` is a format of fmt
/// for the number of a control character, or of one that turns the direction of writing: "\\u{:04X}".
std::string double_quoted(std::string_view text, std::string_view control, Escapes escapes);

}  // namespace coupler::formats
