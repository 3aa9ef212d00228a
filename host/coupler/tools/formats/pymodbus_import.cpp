// SPDX-License-Identifier: Apache-2.0
// The format is that of pymodbus' documentation ("Simulator", "ModbusSimulatorContext") and of the setup.json
// that it ships.
#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "coupler/map/loader/scalar.hpp"
#include "coupler/modbus/limits.hpp"
#include "coupler/tools/formats/foreign_connection.hpp"
#include "coupler/tools/formats/importers.hpp"
#include "coupler/tools/formats/map_tree.hpp"
#include "coupler/tools/formats/pymodbus_memory.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::Position;
using loader::Problems;
using loader::shown;

std::string keys_of(const Entry& entry) {
  std::string keys;
  for (const Entry& child : entry.children) keys += fmt::format("{}{}", keys.empty() ? "" : ", ", child.key);
  return keys;
}

/// The device that was asked for, or the only one; a file of one device is that device.
const Entry* choose(const Entry& root, const std::string& wanted, Problems& problems) {
  if (loader::child(root, "setup") != nullptr) {
    if (wanted.empty()) return &root;
    problems.error(root.at, "the file is one device, which has no name", "leave --device out");
    return nullptr;
  }
  const Entry* list = loader::child(root, "device_list");
  if (list == nullptr || list->children.empty()) {
    problems.error(root.at, "there are no devices in the file",
                   "give a file with a 'device_list', or with one device");
    return nullptr;
  }
  if (wanted.empty() && list->children.size() == 1) return &list->children[0];
  if (const Entry* device = wanted.empty() ? nullptr : loader::child(*list, wanted)) return device;
  problems.error(list->key_at,
                 wanted.empty() ? fmt::format("the file has several devices: {}", keys_of(*list))
                                : fmt::format("there is no device '{}' in the file", wanted),
                 fmt::format("give one of them with --device: {}", keys_of(*list)));
  return nullptr;
}

/// The only one, or the one that the simulator starts if none is named.
const Entry* choose_server(const Entry& root, Problems& problems) {
  const Entry* list = loader::child(root, "server_list");
  if (list == nullptr || list->children.empty()) return nullptr;
  if (list->children.size() == 1) return &list->children[0];
  const Entry* server = loader::child(*list, "server");
  if (server == nullptr)
    problems.warning(list->key_at,
                     fmt::format("the file has several servers: {}; none gives the port", keys_of(*list)),
                     "write the port into the map");
  return server;
}

/// An address that listens on all interfaces is not an address to connect to.
bool is_address(const std::string& host) { return !host.empty() && host != "0.0.0.0" && host != "::"; }

void read_device_id(const Entry& entry, ForeignUnit& unit, Problems& problems) {
  const auto number = loader::parse_unsigned(entry.text);
  if (number && *number < 256)
    unit.unit = static_cast<unsigned>(*number);
  else
    problems.warning(entry.at, fmt::format("{} is not a unit id, so it is left out", shown(entry.text)),
                     "give the device's own with --unit");
  unit.unit_at = entry.at;
}

/// The defaults are those of pymodbus' ModbusSerialServer and ModbusTcpServer.
void read_server(const Entry& server, ForeignUnit& unit, Problems& problems) {
  constexpr LineKeys line = {"port", "baudrate", "bytesize", "parity", "stopbits", "19200", "none", "1"};
  Transport transport = read_transport(loader::child(server, "comm"), {}, problems);
  const Entry* framer = loader::child(server, "framer");  // "method" before pymodbus 3.0
  read_framing(framer != nullptr ? framer : loader::child(server, "method"), transport, problems);
  std::vector<Entry>& keys = unit.map.children;
  if (transport.serial)
    keys.push_back(read_serial_line(server, line, problems));
  else if (transport.rtu)
    keys.push_back(rtu_framing(server.key_at));
  ConversionWarnings own;
  for (const Entry& entry : server.children) {
    if (entry.key == "comm" || entry.key == "framer" || entry.key == "method" ||
        (transport.serial && line.has(entry.key)))
      continue;
    if (entry.key == "port") {
      keys.push_back(scalar("port", entry.text, entry.at));
    } else if (entry.key == "host") {
      if (!transport.serial && is_address(entry.text))
        keys.push_back(scalar("address", entry.text, entry.at));
    } else if (entry.key == "device_id") {
      read_device_id(entry, unit, problems);
    } else {
      own.add("what only the simulator uses is not carried over", "no action is needed", entry.key);
    }
  }
  for (const Diagnostic& loss : own.diagnostics("")) problems.warning(server.key_at, loss.what, loss.remedy);
}

/// Values in one point: what fits into one request.
unsigned most_in(const SimulatedValue& value, bool bits) {
  return bits ? modbus::max_write_bits / (16 * value.registers)
              : modbus::max_write_registers / value.registers;
}

/// The bits of the numbers, least significant first, as they stand in the table.
Entry initial_bits(unsigned number, unsigned count, Position at) {
  Entry list;
  list.key = "initial";
  list.key_at = list.at = at;
  list.kind = Entry::Kind::list;
  for (unsigned i = 0; i < 16 * count; ++i)
    list.children.push_back(scalar("", (number >> (i % 16) & 1U) != 0 ? "on" : "off", at));
  return list;
}

Entry bits_of(const SimulatedValue& value, unsigned count, Entry point, ConversionWarnings& losses) {
  point.children.push_back(scalar("count", fmt::to_string(16 * value.registers * count), value.at));
  const auto number = loader::parse_unsigned(value.value);
  if (value.registers == 1 && number && *number != 0 && *number <= 0xFFFF)
    point.children.push_back(initial_bits(static_cast<unsigned>(*number), count, value.at));
  else if (value.registers > 1)
    losses.add("values of several registers in a table of bits become bits without their values",
               "put them into a table of registers", point.key);
  return point;
}

Entry registers_of(const SimulatedValue& value, unsigned count, Entry point) {
  point.children.push_back(scalar("type", std::string(value.type->iec), value.at));
  std::string text = value.value;
  if (value.type->registers == 0) {
    point.children.push_back(scalar("length", fmt::to_string(2 * value.registers), value.at));
    point.children.push_back(scalar("order", "AB", value.at));
    text.erase(text.find_last_not_of(' ') + 1);  // the simulator fills up with blanks
    if (!text.empty()) point.children.push_back(scalar("initial", text, value.at, true));
    return point;
  }
  if (count > 1) point.children.push_back(scalar("count", fmt::to_string(count), value.at));
  if (!text.empty() && loader::parse_number(text).value_or(1) != 0)
    point.children.push_back(scalar("initial", text, value.at));
  return point;
}

/// In front of the names where addresses are of a block, in the order of `tables`.
constexpr std::string_view blocks[] = {"co_", "di_", "ir_", "hr_"};

Entry mapping_of(const SimulatedMemory& memory, Position at, ConversionWarnings& losses) {
  Entry mapping = section("mapping", at);
  for (const SimulatedValue& value : memory.values()) {
    const auto [table, address] = memory.place_of(value);
    const unsigned step = holds_bits(table) ? 16 * value.registers : value.registers;
    const unsigned most = std::max(1U, most_in(value, holds_bits(table)));
    for (unsigned done = 0; done < value.count; done += most) {
      const unsigned count = std::min(most, value.count - done);
      const unsigned place = address + done * step;
      const std::string_view block = memory.shared() ? "" : blocks[index(table)];
      Entry point = section(fmt::format("{}{}_{}", block, value.type->key, place), value.at);
      point.children.push_back(scalar("address", fmt::to_string(place), value.at));
      point = holds_bits(table) ? bits_of(value, count, std::move(point), losses)
                                : registers_of(value, count, std::move(point));
      if (is_writable(table) && !value.writable) point.children.push_back(scalar("access", "read", value.at));
      make_section(mapping, to_string(table), value.at).children.push_back(std::move(point));
    }
  }
  return mapping;
}

}  // namespace

std::vector<ForeignUnit> read_pymodbus(std::string_view text, const ImportOptions& options,
                                       Problems& problems) {
  const auto root = loader::parse_document(text, problems);
  if (!root) return {};
  const Entry* device = choose(*root, options.device, problems);
  if (device == nullptr) return {};
  ForeignUnit unit;
  unit.map = section("", device->at);
  if (const Entry* server = choose_server(*root, problems)) read_server(*server, unit, problems);
  unit.map.children.push_back(scalar("wordorder_reverse", "true", device->at));
  ConversionWarnings losses;
  const SimulatedMemory memory(*device, losses, problems);
  if (problems.has_errors()) return {};
  losses.add("the simulator has no names: points are named after type and address", "rename them in the map");
  if (memory.shared())
    losses.add(
        "'shared blocks': every table shows every register; here bits are coils, or discrete inputs if they "
        "cannot be written, and all others are holding registers",
        "move points to another table if you read them there");
  unit.map.children.push_back(mapping_of(memory, device->at, losses));
  for (const Diagnostic& loss : losses.diagnostics("")) problems.warning(device->at, loss.what, loss.remedy);
  std::vector<ForeignUnit> units;
  units.push_back(std::move(unit));
  return units;
}

}  // namespace coupler::formats
