// SPDX-License-Identifier: Apache-2.0
// How another program's file says where a device is, as keys of a map. All importers of such files use it.
#pragma once

#include <string_view>

#include "coupler/map/loader/document.hpp"
#include "coupler/map/loader/problems.hpp"

namespace coupler::formats {

/// What a program calls the settings of a serial port, and what it takes where its file does not say one;
/// empty if it refuses such a file, or if that is not known.
struct LineKeys {
  std::string_view device;
  std::string_view baud;
  std::string_view data_bits;
  std::string_view parity;
  std::string_view stop_bits;
  std::string_view usual_baud{};
  std::string_view usual_parity{};
  std::string_view usual_stop_bits{};

  bool has(std::string_view key) const {
    return key == device || key == baud || key == data_bits || key == parity || key == stop_bits;
  }
};

/// The map's `serial`, from those keys of `given`. Warns of each value that a map cannot have, where it
/// stands.
loader::Entry read_serial_line(const loader::Entry& given, const LineKeys& keys, loader::Problems& problems);

/// What carries the frames to a device, and how they are told apart.
struct Transport {
  bool serial = false;  ///< otherwise TCP
  bool rtu = false;     ///< always so on a serial line
};

/// Reads Home Assistant's `type`, Unslave's `mode`, pymodbus' `comm`: "serial", "RTU", "rtuovertcp",
/// "RTU_OVER_TCP", "udp" … Warns of what a map does not have. `usual`: if the word is nullptr or null.
Transport read_transport(const loader::Entry* word, Transport usual, loader::Problems& problems);

/// Reads Home Assistant's `method` and pymodbus' `framer`: "rtu", "ascii", "socket" … Warns of what a map
/// does not have there. The word may be nullptr or null.
void read_framing(const loader::Entry* word, Transport& transport, loader::Problems& problems);

/// The map's `framing: rtu`, which RTU over TCP needs.
loader::Entry rtu_framing(loader::Position at);

}  // namespace coupler::formats
