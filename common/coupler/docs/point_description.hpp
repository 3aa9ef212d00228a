// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "coupler/map/map.hpp"

namespace coupler::docs {

/// The texts of the pages about one point, not yet escaped for any format. An empty text is left out.
struct PointDescription {
  std::string name;
  std::string description;
  Table table = Table::coils;
  std::uint32_t first = 0;  ///< zero-based address
  std::uint32_t last = 0;
  std::string address;  ///< "3", "3 – 4"
  std::string modicon;  ///< "40004", "40004 – 40005"
  std::string part;     ///< of a register: "bit 3", "high byte"
  std::string read_at;  ///< "512 (40513)", where an output reads back elsewhere
  std::string type;     ///< "REAL"
  std::string text;     ///< of a STRING: "12 bytes, latin-1"
  std::string order;    ///< "CDAB", registers only
  std::string count;    ///< "4", of an array
  std::string scale;    ///< "raw × 0.1 - 40"
  std::string invalid;  ///< "0x8000, 0xFFF0 to 0xFFFF": what the device gives for no value
  std::string faults;   ///< "below 3600, above 21000": of the raw value
  std::string units;
  std::string range;           ///< of the published value, "-32768 … 32767"
  std::string access;          ///< "read", "write", "read, write"
  std::string source;          ///< of the value on a node: "GPIO17", "iio ads1015 voltage0", "counter"
  std::string source_details;  ///< "active low, pull-up, debounce 5 ms"
  std::string initial;
  std::string safe;
  std::string pulse;     ///< "200 ms"
  std::string deadman;   ///< "0 after 500 ms"
  std::string priority;  ///< "high", of writes that go first
  std::string rate;      ///< "50 Hz", of a point that is read at a rate of its own
  std::string message;   ///< "std_msgs/Bool"
  int line = 0;          ///< of the map's file; 0: unknown
};

/// `line`: as PointDescription::line.
PointDescription describe(const Point& point, int line);

}  // namespace coupler::docs
