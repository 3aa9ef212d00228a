// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/exporters.hpp"

#include <fmt/format.h>

#include "coupler/codec/text.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/network.hpp"

namespace coupler::formats {

namespace {

/// A string of Lua, quotes included, that stands for exactly these bytes.
std::string lua_literal(std::string_view text) { return double_quoted(text, "\\{:03}", Escapes::bytes); }

/// Names of protocols and of their fields: lower case, digits, '_'.
std::string protocol_of(std::string_view name) {
  std::string out = "coupler_" + lower(name);
  for (char& c : out)
    if (!loader::is_letter(c) && !loader::is_digit(c)) c = '_';
  return out;
}

void add_format(const Point& point, std::string& row) {
  const codec::Format& format = point.format;
  row += fmt::format(", type = \"{}\", bits = {}, words_reversed = {}, bytes_swapped = {}",
                     to_string(format.type), codec::width(format.type), codec::words_reversed(format.order),
                     codec::bytes_swapped(format.order));
  if (format.type == codec::Type::BOOL) row += fmt::format(", bit = {}", format.bit);
  if (format.bits != 0)
    row += fmt::format(", bit = {}, width = {}", format.bit, format.bits);
  else if (codec::width(format.type) == 8)
    row += fmt::format(", high = {}", format.half == codec::Half::high);
  if (format.type == codec::Type::STRING)
    row += fmt::format(", length = {}, encoding = \"{}\"", format.length, codec::to_string(format.encoding));
  if (point.scale.present())
    row += fmt::format(", gain = {}, offset = {}", point.scale.gain, point.scale.offset);
}

std::string row_of(const Point& point) {
  std::string row = fmt::format(
      "    {{ name = {}, table = \"{}\", address = {}, size = {}, count = {}, readable = {}, writable = {}",
      lua_literal(point.name), to_string(point.table), point.address, range(point).count(), point.count,
      is_readable(point), is_writable(point));
  if (point.read_address) row += fmt::format(", read_from = {}", *point.read_address);
  if (!holds_bits(point.table)) add_format(point, row);
  if (!point.values.empty()) {
    row += ", names = {";
    for (const NamedValue& named : point.values)
      row += fmt::format(" [\"{}\"] = {},", named.value, lua_literal(named.name));
    row += " }";
  }
  if (!point.units.empty()) row += ", units = " + lua_literal(point.units);
  if (!point.description.empty()) row += ", description = " + lua_literal(point.description);
  return row + " },\n";
}

}  // namespace

Export write_wireshark(const Map& map) {
  Export out;
  const std::string proto = protocol_of(map.name);
  out.text = fmt::format(
      "-- Names the points of the map {0} in captures of Modbus/TCP: Wireshark 4 and tshark 4.\n"
      "-- Made by `coupler export --to wireshark`.\n"
      "--   wireshark -X lua_script:FILE capture.pcapng\n"
      "--   tshark -X lua_script:FILE -r capture.pcapng -V\n"
      "-- or copy it into the folder for plugins (Help, About Wireshark, Folders). The device listens on "
      "port {1};\n"
      "-- another one: -o {2}.port:N. If several maps have one port, where the device is: -o "
      "{2}.address:IP.\n"
      "-- Filters: {2}.point == \"NAME\", {2}.value == \"…\", of a node's function codes 65 and 66\n"
      "-- {2}.longest_wait, epoch, seen, newest, lost, number, duration, outcome.\n\n"
      "local map = {{\n"
      "  name = {3}, proto = \"{2}\", unit = {4}, port = {1}, address = {5},\n"
      "  points = {{\n",
      map.name, port_without_tls(map), proto, lua_literal(map.name), map.connection.unit,
      lua_literal(is_ip_address(map.connection.address) ? map.connection.address : ""));
  for (const Point& point : map.points) out.text += row_of(point);
  out.text += "  },\n}\n\n";
  out.text += wireshark_body();
  if (map.connection.is_rtu())
    out.warnings.add(
        "the dissector is for captures of Modbus/TCP, and the coupler speaks RTU",
        fmt::format("capture at a gateway that translates, and give its port: -o {}.port:N", proto));
  for (const Point& point : map.points) warn_of_raw_meaning(point, false, out.warnings);
  warn_of_node_and_driver_keys(map, out.warnings);
  return out;
}

}  // namespace coupler::formats
