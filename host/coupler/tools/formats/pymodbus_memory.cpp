// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/pymodbus_memory.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/map/loader/scalar.hpp"
#include "coupler/tools/formats/map_tree.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::shown;

constexpr SimulatedType simulated_types[] = {
    {"bits", 1, "WORD"},    {"int16", 1, "INT"},     {"uint16", 1, "UINT"},  {"uint32", 2, "UDINT"},
    {"float32", 2, "REAL"}, {"float64", 4, "LREAL"}, {"string", 0, "STRING"}};

/// "kwargs" and "parameters" are the action's.
constexpr std::string_view entry_keys[] = {"addr", "value", "action", "kwargs", "parameters"};

constexpr unsigned most_cells = 4 * 65536;

bool is_list(const Entry& entry) { return entry.kind == Entry::Kind::list; }

}  // namespace

SimulatedMemory::SimulatedMemory(const Entry& device, ConversionWarnings& losses, loader::Problems& problems)
    : losses_(losses), problems_(problems) {
  read_setup(device);
  for (const SimulatedType& type : simulated_types)
    if (const Entry* entries = loader::child(device, type.key))
      for (const Entry& entry : entries->children) define(type, entry);
  if (problems_.has_errors()) return;
  allow_writing(device);
  repeat(device);
  for (const Entry& entry : device.children) {
    const bool known = entry.key == "setup" || entry.key == "invalid" || entry.key == "write" ||
                       entry.key == "repeat" ||
                       std::any_of(std::begin(simulated_types), std::end(simulated_types),
                                   [&](const auto& t) { return t.key == entry.key; });
    if (!known)
      problems_.error(entry.key_at,
                      fmt::format("{} is not a part of a device of the simulator", shown(entry.key)),
                      "write bits, uint16, uint32, float32, float64 or string");
  }
}

void SimulatedMemory::read_setup(const Entry& device) {
  const Entry* setup = loader::child(device, "setup");
  if (setup == nullptr) {
    problems_.error(device.at, "the device has no 'setup'", "give the sizes of its tables in one");
    return;
  }
  defaults_ = loader::child(*setup, "defaults");
  const Entry* shared = loader::child(*setup, "shared blocks");
  shared_ = shared != nullptr && loader::parse_boolean(shared->text).value_or(false);
  constexpr std::string_view sizes[] = {"co size", "di size", "ir size", "hr size"};
  unsigned total = 0;
  for (std::size_t i = 0; i < std::size(sizes); ++i) {
    const Entry* given = loader::child(*setup, sizes[i]);
    const auto size = given != nullptr ? loader::parse_unsigned(given->text) : std::nullopt;
    if (!size || *size > 65536) {
      problems_.error(given != nullptr ? given->at : setup->at,
                      fmt::format("'{}' is not a number of registers from 0 to 65536", sizes[i]),
                      "write such a number");
      return;
    }
    total = shared_ ? std::max(total, static_cast<unsigned>(*size)) : total + static_cast<unsigned>(*size);
    ends_[i] = total;
  }
  cells_.resize(std::min(total, most_cells));
}

const Entry* SimulatedMemory::default_of(std::string_view what, std::string_view type) const {
  const Entry* all = defaults_ != nullptr ? loader::child(*defaults_, what) : nullptr;
  return all != nullptr ? loader::child(*all, type) : nullptr;
}

bool SimulatedMemory::read_range(const Entry& given, unsigned& first, unsigned& last) const {
  const Entry* from = is_list(given) && given.children.size() == 2 ? &given.children[0] : &given;
  const Entry* to = is_list(given) && given.children.size() == 2 ? &given.children[1] : &given;
  const auto low = loader::parse_unsigned(from->text);
  const auto high = loader::parse_unsigned(to->text);
  if (low && high && *low <= *high && *high < cells_.size()) {
    first = static_cast<unsigned>(*low);
    last = static_cast<unsigned>(*high);
    return true;
  }
  problems_.error(given.at, fmt::format("this is not a register below {}, and no two of them", cells_.size()),
                  "write one number, or the first and the last register in brackets");
  return false;
}

void SimulatedMemory::lose_action(const SimulatedType& type, const Entry& action) {
  if (action.kind == Entry::Kind::null || action.text.empty()) return;
  losses_.add(fmt::format("the action {} is not carried over: there the simulator changes values by itself",
                          shown(action.text)),
              "no action is needed to read them", type.key);
}

void SimulatedMemory::define(const SimulatedType& type, const Entry& entry) {
  const bool is_map = entry.kind == Entry::Kind::map;
  const Entry* place = is_map ? loader::child(entry, "addr") : &entry;
  unsigned first = 0;
  unsigned last = 0;
  if (place == nullptr)
    return problems_.error(entry.at, "there is no 'addr'", "write the registers of the value");
  if (!read_range(*place, first, last)) return;
  const unsigned size = type.registers == 0 ? last - first + 1 : type.registers;
  if ((last - first + 1) % size != 0)
    return problems_.error(place->at,
                           fmt::format("{} registers are not whole values of {}", last - first + 1, type.key),
                           fmt::format("give each value {} registers", size));
  const Entry* value = is_map ? loader::child(entry, "value") : nullptr;
  if (value == nullptr) value = default_of("value", type.key);
  const Entry* action = is_map ? loader::child(entry, "action") : nullptr;
  if (action == nullptr) action = default_of("action", type.key);
  if (action != nullptr) lose_action(type, *action);
  if (is_map)
    for (const Entry& key : entry.children)
      if (std::find(std::begin(entry_keys), std::end(entry_keys), key.key) == std::end(entry_keys))
        problems_.warning(
            key.key_at, fmt::format("{} is not carried over: the simulator ignores it, too", shown(key.key)),
            "no action is needed");
  ++definitions_;
  for (unsigned i = first; i <= last; ++i) {
    SimulatedCell& cell = cells_[i];
    if (cell.type != nullptr || cell.continues)
      return problems_.error(place->at, fmt::format("register {} is defined twice", i), "define it once");
    const bool begins = (i - first) % size == 0;
    cell.type = begins ? &type : nullptr;
    cell.continues = !begins;
    cell.definition = definitions_;
    cell.value = begins && value != nullptr ? value->text : "";
    cell.at = entry.at;
  }
}

void SimulatedMemory::allow_writing(const Entry& device) {
  const Entry* write = loader::child(device, "write");
  if (write == nullptr) return;
  for (const Entry& given : write->children) {
    unsigned first = 0;
    unsigned last = 0;
    if (!read_range(given, first, last)) continue;
    for (unsigned i = first; i <= last; ++i) {
      if (cells_[i].type == nullptr && !cells_[i].continues) {
        problems_.error(given.at, fmt::format("register {} may be written, but is not defined", i),
                        "give it a type");
        break;
      }
      cells_[i].writable = true;
    }
  }
}

void SimulatedMemory::repeat(const Entry& device) {
  const Entry* all = loader::child(device, "repeat");
  if (all == nullptr) return;
  for (const Entry& given : all->children) {
    const Entry* from = loader::child(given, "addr");
    const Entry* to = loader::child(given, "to");
    if (from == nullptr || to == nullptr) {
      problems_.error(given.at, "a repetition without 'addr' or 'to'", "write both");
      continue;
    }
    unsigned first = 0;
    unsigned last = 0;
    unsigned to_first = 0;
    unsigned to_last = 0;
    if (!read_range(*from, first, last) || !read_range(*to, to_first, to_last)) continue;
    const unsigned before = definitions_;  // a copy of the n-th definition is another one
    for (unsigned i = to_first, source = first; i <= to_last; ++i) {
      if (source == first) definitions_ += before + 1;
      cells_[i] = cells_[source];
      cells_[i].definition += definitions_;
      source = source == last ? first : source + 1;
    }
    definitions_ += before + 1;
  }
}

unsigned SimulatedMemory::table_end(unsigned cell) const {
  if (shared_) return ends_[3];
  return *std::find_if(ends_, ends_ + 3, [cell](unsigned end) { return cell < end; });
}

SimulatedPlace SimulatedMemory::place_of(const SimulatedValue& value) const {
  if (shared_) {
    const bool bits = value.type->key == "bits" && 16 * (value.first + value.count) <= 65536;
    if (!bits) return {Table::holding_registers, value.first};
    return {value.writable ? Table::coils : Table::discrete_inputs, 16 * value.first};
  }
  std::size_t table = 0;
  while (value.first >= ends_[table]) ++table;
  const unsigned in_table = value.first - (table > 0 ? ends_[table - 1] : 0);
  return {tables[table], holds_bits(tables[table]) ? 16 * in_table : in_table};
}

std::vector<SimulatedValue> SimulatedMemory::values() const {
  std::vector<SimulatedValue> out;
  unsigned definition = 0;  // of the last value
  for (unsigned i = 0; i < cells_.size();) {
    const SimulatedCell& cell = cells_[i];
    unsigned size = 1;
    bool writable = cell.writable;
    while (i + size < cells_.size() && cells_[i + size].continues && cell.type != nullptr &&
           (cell.type->registers == 0 || size < cell.type->registers))
      writable = cells_[i + size++].writable && writable;
    const bool whole = cell.type != nullptr && (cell.type->registers == 0 || size == cell.type->registers) &&
                       i + size <= table_end(i);
    if (!whole) {
      if (cell.type != nullptr || cell.continues)
        problems_.warning(cell.at, fmt::format("register {} is a part of a value, so it is left out", i),
                          "repeat whole values, in one table");
    } else if (!out.empty() && out.back().type == cell.type && cell.type->registers > 0 &&
               definition == cell.definition && out.back().writable == writable &&
               out.back().first + out.back().count * size == i &&
               table_end(out.back().first) == table_end(i)) {
      ++out.back().count;
    } else {
      out.push_back({cell.type, i, 1, size, writable, cell.value, cell.at});
      definition = cell.definition;
    }
    i += whole ? size : 1;
  }
  return out;
}

}  // namespace coupler::formats
