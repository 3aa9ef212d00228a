// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "common/formats/exporter.hpp"

namespace coupler::formats {

/// A dissector in Lua for Wireshark and tshark: below what they say of Modbus/TCP it names the map's points
/// and their values, in requests and, matched by connection and transaction id, in replies.
Export write_wireshark(const Map& map);

/// wireshark.lua: the part of the dissector that no map changes.
std::string_view wireshark_body();

}  // namespace coupler::formats
