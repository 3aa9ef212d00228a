// SPDX-License-Identifier: Apache-2.0
// What a foreign format must bring to be exported to: one function, and its row in exporters.cpp.
#pragma once

#include <string>
#include <string_view>

#include "coupler/base/span.hpp"
#include "coupler/formats/conversion_warnings.hpp"
#include "coupler/map/map.hpp"

namespace coupler::formats {

struct Export {
  std::string text;
  ConversionWarnings warnings;  ///< what the format cannot say
};

struct Exporter {
  std::string_view name;  ///< at the command line
  std::string_view summary;
  Export (*write)(const Map& map);  ///< the same text for the same map
};

// A function for each format.

/// The table that `coupler import csv` reads: all that the map says of its points, with addresses as on the
/// wire and orders written out, so that the map made from it has the same fingerprint.
Export write_csv(const Map& map);

/// `modbus:` of Home Assistant's configuration.yaml: coils are switches, discrete inputs and bits binary
/// sensors, registers sensors.
Export write_home_assistant(const Map& map);

/// A section [[inputs.modbus]] for Telegraf, in the plugin's "request" style: one request for each table and
/// byte order, which Telegraf parts into as many reads as it needs.
Export write_telegraf(const Map& map);

/// A dissector in Lua for Wireshark and tshark: below what they say of Modbus/TCP it names the map's points
/// and their values, in requests and, matched by connection and transaction id, in replies.
Export write_wireshark(const Map& map);

/// wireshark.lua: the part of the dissector that no map changes.
std::string_view wireshark_body();

Span<const Exporter> exporters();

/// The exporter of that name, or nullptr.
const Exporter* find_exporter(std::string_view name);

}  // namespace coupler::formats
