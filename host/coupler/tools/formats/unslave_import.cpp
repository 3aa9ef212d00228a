// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/importers.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "coupler/map/loader/document.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/table.hpp"
#include "coupler/tools/formats/foreign_connection.hpp"
#include "coupler/tools/formats/map_tree.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::Problems;
using loader::shown;

struct Kind {
  std::string_view letters;
  Table table;
};
constexpr Kind kinds[] = {{"HR", Table::holding_registers},
                          {"IR", Table::input_registers},
                          {"DI", Table::discrete_inputs},
                          {"C", Table::coils}};

/// "HR10" or "hr10"; nullptr if it is not a register value key.
const Kind* kind_of(std::string_view key) {
  for (const Kind& kind : kinds) {
    const std::string_view number = key.substr(std::min(kind.letters.size(), key.size()));
    if (lower(key.substr(0, kind.letters.size())) == lower(kind.letters) && !number.empty() &&
        std::all_of(number.begin(), number.end(), loader::is_digit))
      return &kind;
  }
  return nullptr;
}

/// The unit's registers.
class RegisterReader {
 public:
  RegisterReader(Entry& mapping, Problems& problems) : mapping_(mapping), problems_(problems) {}

  void read(const Entry& given) {
    const Kind* kind = kind_of(given.key);
    if (kind == nullptr) {
      problems_.warning(given.key_at,
                        fmt::format("{} is not a register, so it is left out", shown(given.key)),
                        "write HR, IR, C or DI and the address");
      return;
    }
    const std::string number = without_zeros(given.key.substr(kind->letters.size()));
    const std::string name = lower(kind->letters) + "_" + number;
    if (!seen_.insert(name).second) {
      problems_.warning(given.key_at,
                        fmt::format("{} is given twice, so this one is left out", shown(given.key)),
                        "keep one of the two");
      return;
    }
    Entry point = section(name, given.key_at);
    point.children.push_back(scalar("address", number, given.key_at));
    if (!holds_bits(kind->table)) point.children.push_back(scalar("type", "UINT", given.key_at));
    read_value(given, kind->table, point);
    make_section(mapping_, to_string(kind->table), given.key_at).children.push_back(std::move(point));
  }

 private:
  static std::string without_zeros(std::string_view number) {
    const std::size_t first = number.find_first_not_of('0');
    return std::string(first == std::string_view::npos ? "0" : number.substr(first));
  }

  /// A value that is the default is not written.
  void read_value(const Entry& given, Table table, Entry& point) {
    if (given.kind == Entry::Kind::map) {
      problems_.warning(
          given.at, fmt::format("the exception that {} answers with is not carried over", shown(given.key)),
          "list addresses that a device refuses under 'unreadable'");
      return;
    }
    const bool is_scalar = given.kind == Entry::Kind::scalar;
    const auto number = is_scalar ? loader::parse_integer(given.text) : std::nullopt;
    const auto on = is_scalar ? loader::parse_boolean(given.text) : std::nullopt;
    if (holds_bits(table) && (on || number)) {
      if (on.value_or(number.value_or(0) != 0)) point.children.push_back(scalar("initial", "on", given.at));
    } else if (!holds_bits(table) && number && *number >= -32768 && *number <= 65535) {
      if (*number != 0)
        point.children.push_back(scalar("initial", fmt::to_string(*number & 0xFFFF), given.at));
    } else {
      problems_.error(given.at,
                      fmt::format("the value of {} is {}, not {}", shown(given.key),
                                  is_scalar ? shown(given.text) : "a list",
                                  holds_bits(table) ? "true or false" : "a number from -32768 to 65535"),
                      "write what the register holds");
    }
  }

  Entry& mapping_;
  Problems& problems_;
  std::set<std::string> seen_;
};

std::optional<ForeignUnit> read_slave(const Entry& slave, Problems& problems) {
  const auto number = loader::parse_unsigned(slave.key);
  if (!number || *number > 255) {
    problems.error(slave.key_at, fmt::format("{} is not a unit id", shown(slave.key)),
                   "write a number from 0 to 255");
    return std::nullopt;
  }
  ForeignUnit unit;
  unit.unit = static_cast<unsigned>(*number);
  unit.map = section("", slave.key_at);
  Entry mapping = section("mapping", slave.key_at);
  RegisterReader reader(mapping, problems);
  for (const Entry& entry : slave.children) {
    if (entry.key == "registers")
      for (const Entry& given : entry.children) reader.read(given);
    else if (entry.key != "isOnline" || !loader::parse_boolean(entry.text).value_or(false))
      problems.warning(entry.key_at,
                       fmt::format("{} is not carried over: a map has no key for it", shown(entry.key)),
                       "no action is needed if the device itself does it");
  }
  unit.map.children.push_back(std::move(mapping));
  return unit;
}

/// Returns the settings of the serial port: the section `port`, as in the manual, or `serial`; or those
/// beside `port`. nullptr if there are none.
const Entry* line_of(const Entry& root) {
  for (const std::string_view key : {"port", "serial"}) {
    const Entry* line = loader::child(root, key);
    if (line != nullptr && line->kind == Entry::Kind::map) return line;
    if (line != nullptr && line->kind == Entry::Kind::scalar && key == "port") return &root;
  }
  return nullptr;
}

LineKeys line_keys_of(const Entry& line) {
  return {loader::child(line, "name") != nullptr ? "name" : "port", "baudRate", "dataBits", "parity",
          "stopBits"};
}

void report_simulators(const Entry& entry, Problems& problems) {
  problems.warning(entry.key_at,
                   fmt::format("{} is not carried over: it belongs to the simulator", shown(entry.key)),
                   "no action is needed");
}

/// The connection: what `mode` says, else a serial line, or TCP where only its port is given. Warns of keys
/// that belong to the simulator.
std::vector<Entry> read_device(const Entry& root, Problems& problems) {
  std::vector<Entry> keys;
  const Entry* mode = loader::child(root, "mode");
  const Entry none = section("serial", root.at);
  const Entry* line = line_of(root);
  const bool is_serial = line != nullptr || loader::child(root, "tcpPort") == nullptr;
  const Transport transport = read_transport(mode, {is_serial, is_serial}, problems);
  const Entry& given = line != nullptr ? *line : none;
  const LineKeys line_keys = line_keys_of(given);
  if (transport.serial) {
    keys.push_back(read_serial_line(given, line_keys, problems));
    if (line != &root)
      for (const Entry& entry : given.children)
        if (!line_keys.has(entry.key)) report_simulators(entry, problems);
  } else if (transport.rtu) {
    keys.push_back(rtu_framing(mode->at));
  }
  for (const Entry& entry : root.children) {
    if (entry.key == "tcpPort") {
      if (!transport.serial) keys.push_back(scalar("port", entry.text, entry.at));
    } else if (&entry != line && !(line == &root && line_keys.has(entry.key)) && entry.key != "slaves" &&
               entry.key != "mode" && entry.key != "version") {
      report_simulators(entry, problems);
    }
  }
  return keys;
}

}  // namespace

std::vector<ForeignUnit> read_unslave(std::string_view text, const ImportOptions& /*options*/,
                                      Problems& problems) {
  const auto root = loader::parse_document(text, problems);
  if (!root) return {};
  const Entry* slaves = loader::child(*root, "slaves");
  if (slaves == nullptr || slaves->kind != Entry::Kind::map || slaves->children.empty()) {
    problems.error(slaves != nullptr ? slaves->key_at : root->at, "there are no 'slaves' in the file",
                   "give the configuration of an Unslave simulation");
    return {};
  }
  const std::vector<Entry> device = read_device(*root, problems);
  std::vector<ForeignUnit> units;
  for (const Entry& slave : slaves->children) {
    auto unit = read_slave(slave, problems);
    if (!unit) continue;
    unit->map.children.insert(unit->map.children.begin(), device.begin(), device.end());
    units.push_back(std::move(*unit));
  }
  problems.warning(slaves->key_at,
                   "Unslave has no types and no names: registers become UINT, and points are named after "
                   "their table and address",
                   "join registers of wide values and rename points in the map");
  return units;
}

}  // namespace coupler::formats
