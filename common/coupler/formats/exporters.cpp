// SPDX-License-Identifier: Apache-2.0
#include "coupler/formats/exporters.hpp"

#include <algorithm>
#include <iterator>

namespace coupler::formats {
namespace {

constexpr Exporter table[] = {
    {"csv", "a table of points, for spreadsheets and for `coupler import csv`", write_csv},
    {"home-assistant", "the modbus integration's part of configuration.yaml", write_home_assistant},
    {"telegraf", "a section [[inputs.modbus]] of telegraf.conf", write_telegraf},
    {"wireshark", "a dissector (Lua) that names the points in captures", write_wireshark},
};

}  // namespace

Span<const Exporter> exporters() { return table; }

const Exporter* find_exporter(std::string_view name) {
  const auto* found = std::find_if(std::begin(table), std::end(table),
                                   [name](const Exporter& exporter) { return exporter.name == name; });
  return found == std::end(table) ? nullptr : found;
}

}  // namespace coupler::formats
