// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/point_reader.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "coupler/map/loader/reader.hpp"
#include "coupler/map/loader/scalar.hpp"

namespace coupler::loader {
namespace {

void read_address(const Entry* entry, Addressing addressing, DraftPoint& draft, const Context& context) {
  draft.addressless = entry == nullptr;
  if (draft.addressless) return;
  draft.address_at = entry->at;
  if (entry->kind != Entry::Kind::scalar) {
    context.problems.error(entry->at, fmt::format("the address must be a number, not {}", shown(*entry)),
                           entry->kind == Entry::Kind::list
                               ? "write the first address; 'count' says how many follow"
                               : "write the number");
    return;
  }
  if (is_entry_without_colon(*entry, context)) return;
  const auto address = parse_address(entry->text, draft.point.table, addressing);
  if (entry->quoted && address) {
    context.problems.error(entry->at, fmt::format("the address must be a number, not {}", shown(*entry)),
                           "write the number, without quotes");
    return;
  }
  if (address)
    draft.point.address = *address;
  else
    context.problems.error(entry->at, address.error().what, address.error().remedy);
}

/// A key that says where the point is, or how large it is, is misspelt. An error has named it.
bool misspells_size(const Reader& reader) {
  const auto keys = {"address", "type", "length", "count", "bit", "offset"};
  return std::any_of(keys.begin(), keys.end(), [&](const char* key) { return reader.misspells(key); });
}

void check_range(const DraftPoint& draft, const Context& context) {
  const Point& point = draft.point;
  const std::uint32_t size = std::uint32_t{point.count} * codec::registers(point.format);
  if (modbus::Range::make(point.address, size)) return;
  context.problems.error(draft.address_at,
                         fmt::format("{} needs {} {} from {} on, past 65535", shown(point.name), size,
                                     holds_bits(point.table) ? "addresses" : "registers", point.address),
                         fmt::format("the last address for it is {}", 65536 - size));
}

/// An array's elements stand one behind the other, so they must fill whole registers.
void read_count(const Reader& reader, Point& point, const Context& context) {
  const Entry* entry = reader.find("count");
  if (entry == nullptr) return;
  reader.integer("count", point.count);
  if (point.count == 1 || holds_bits(point.table)) return;
  const codec::Type type = point.format.type;
  if (type == codec::Type::STRING || is_partial(point))
    context.problems.error(entry->key_at,
                           fmt::format("there are no arrays of {}",
                                       point.format.bits != 0 ? "numbers in bits" : to_string(type)),
                           type == codec::Type::STRING
                               ? "write one point for each text"
                               : "write one point each, or use a type of whole registers");
}

/// Hardware is behind single values.
void check_array(const Reader& reader, const Point& point, const Context& context) {
  if (point.count == 1) return;
  for (const std::string_view key : {"line", "counter", "latched", "pulse", "iio", "pwm"}) {
    if (find_key(key, section_of(point.table)) == nullptr) continue;
    if (const Entry* entry = reader.find(key))
      context.problems.error(entry->key_at, fmt::format("'{}' does not apply to an array", key),
                             "write one point for each value");
  }
}

/// An output that ends by itself begins as 0, and is not left at 1.
void read_pulse(const Reader& reader, Point& point, const Context& context) {
  if (point.table != Table::coils || !reader.has("pulse")) return;
  const std::size_t errors = context.problems.errors();
  reader.duration("pulse", point.pulse);
  if (!is_writable(point))
    reader.refuse("pulse", "'pulse' is for a point that is written, but this one has 'access: read'",
                  "remove it");
  if (point.latched.present())
    reader.refuse("pulse", "a point has 'pulse' or 'latched', not both", "remove one of the two");
  if (point.safe == Safe::on)
    reader.refuse("safe", "'safe' is on, but a pulse ends by itself", "write 'safe: off', or remove 'pulse'");
  if (!point.initial.empty() && point.initial[0] != 0)
    reader.refuse("initial", "'initial' is on, but a pulse begins when it is written",
                  "remove 'initial', or 'pulse'");
  if (context.problems.errors() != errors) point.pulse = {};
}

void read_read_address(const Reader& reader, Addressing addressing, Point& point, const Context& context) {
  const Entry* entry = is_writable(point.table) ? reader.find("read_address") : nullptr;
  if (entry == nullptr) return;
  const auto address =
      parse_address(entry->kind == Entry::Kind::scalar ? entry->text : "", point.table, addressing);
  if (!address)
    context.problems.error(entry->at, address.error().what, address.error().remedy);
  else if (!is_readable(point))
    context.problems.error(entry->key_at,
                           "'read_address' is for a point that is read, but this one has 'access: write'",
                           "remove one of the two");
  else if (!modbus::Range::make(*address, range(point).count()))
    context.problems.error(entry->at,
                           fmt::format("{} does not fit there, it would end past 65535", shown(point.name)),
                           "write a smaller address");
  else
    point.read_address = *address;
}

void read_access(const Reader& reader, Point& point, const Context& context) {
  const Entry* entry = reader.find("access");
  if (entry == nullptr) return;
  Access access = point.access;
  reader.choice("access", access);
  if (access == Access::read || is_writable(point.table))
    point.access = access;
  else
    context.problems.error(entry->at, fmt::format("{} can only be read", to_string(point.table)),
                           "remove 'access'");
}

/// Parts "0.1V" or "10 W" into the power of ten and the unit alone behind it. Anything else gives two empty
/// texts.
std::pair<std::string_view, std::string_view> power_and_unit(std::string_view units) {
  for (const std::string_view power : {"0.001", "0.01", "0.1", "10", "100", "1000"}) {
    if (units.substr(0, power.size()) != power) continue;
    std::string_view unit = units.substr(power.size());
    unit.remove_prefix(std::min(unit.find_first_not_of(' '), unit.size()));
    const auto is_of_unit = [](char c) {
      return is_letter(c) || c == '%' || c == '/' || (static_cast<unsigned char>(c) & 0x80U) != 0;
    };
    const bool is_unit = !unit.empty() && unit[0] != '/' && std::all_of(unit.begin(), unit.end(), is_of_unit);
    if (is_unit) return {power, unit};
  }
  return {};
}

/// "0.1V" in a maker's table means a register in tenths of a volt.
void warn_of_scaled_units(const Reader& reader, const Point& point, const Context& context) {
  if (!codec::is_scalable(point.format.type) || reader.has("scale")) return;
  const auto [power, unit] = power_and_unit(point.units);
  if (unit.empty()) return;
  context.problems.warning(
      reader.find("units")->at,
      fmt::format("the units {} do not scale the value: {} is published as it is in the register",
                  shown(point.units), shown(point.name)),
      fmt::format("write 'scale: {}' and the units {}", power, shown(unit)));
}

void check_has_options(const Entry& entry, const Context& context) {
  if (entry.kind == Entry::Kind::map || entry.kind == Entry::Kind::null) return;
  const std::string given = entry.kind == Entry::Kind::scalar ? entry.text.substr(0, 10) : "0";
  context.problems.error(
      entry.at, fmt::format("{} has no type", shown(entry.key)),
      fmt::format("write it as in '{}: {{address: {}, type: INT}}'", entry.key.substr(0, 40), given));
}

}  // namespace

DraftPoint read_place(const Entry& entry, Table table, const PointDefaults& defaults,
                      const Context& context) {
  DraftPoint draft{&entry, Reader(entry, section_of(table), context)};
  const Reader& options = draft.options;
  draft.name_at = entry.key_at;
  draft.address_at = entry.key_at;
  Point& point = draft.point;
  point.name = context.map.keep(entry.key);
  point.table = table;
  point.access = is_writable(table) ? Access::read_write : Access::read;
  const bool bits = holds_bits(table);
  const bool has_options = entry.kind == Entry::Kind::map || entry.kind == Entry::Kind::null;
  const std::size_t errors = context.problems.errors();
  if (!bits) check_has_options(entry, context);
  read_address(bits && !has_options ? &entry : options.find("address"), defaults.addressing, draft, context);
  if (!bits && has_options) read_format(options, entry, defaults.order, point.format, context);
  draft.part_given = !bits && (options.has("offset") || options.has("bit") || options.has("bits"));
  const auto good_so_far = [&] { return context.problems.errors() == errors && !misspells_size(options); };
  if (good_so_far()) read_count(options, point, context);
  if (good_so_far() && !draft.addressless) check_range(draft, context);
  const bool good = good_so_far();
  draft.placed = good && !draft.addressless;
  draft.addressless = good && draft.addressless;
  read_access(options, point, context);
  if (good) read_read_address(options, defaults.addressing, point, context);
  return draft;
}

void read_rest(const PointDefaults& defaults, DraftPoint& draft, const Context& context) {
  const Reader& options = draft.options;
  Point& point = draft.point;
  if (draft.placed && !holds_bits(point.table)) {
    read_scale(options, point, context);
    read_invalid(options, point, context);
    read_faults(options, point, context);
    read_allowed_values(options, point, context);
  }
  if (const Entry* initial = options.find("initial"); draft.placed && initial != nullptr)
    point.initial = read_value("initial", *initial, point, context);
  if (holds_bits(point.table))
    read_line(options, draft, context);
  else
    read_channel(options, draft, context);
  check_start(options, point, context);
  read_edges(options, draft, context);
  read_pulse(options, point, context);
  check_array(options, point, context);
  read_host_options(options, defaults.host, draft, context);
  options.text("description", point.description);
  options.text("units", point.units);
  warn_of_scaled_units(options, point, context);
}

}  // namespace coupler::loader
