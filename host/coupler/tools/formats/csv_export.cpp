// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/exporters.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

#include <fmt/format.h>

#include "coupler/base/csv_cell.hpp"
#include "coupler/codec/text.hpp"
#include "coupler/map/fields.hpp"
#include "coupler/map/loader/document.hpp"
#include "coupler/map/loader/keys.hpp"
#include "coupler/tools/formats/csv.hpp"
#include "coupler/tools/formats/csv_headings.hpp"
#include "coupler/tools/formats/map_tree.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using Cells = std::map<std::string, std::string, std::less<>>;  // by column

std::string scale_text(const codec::Scale& scale) {
  if (scale.offset == 0 && !scale.has_exponent()) return fmt::to_string(scale.gain);
  return fmt::format("{{gain: {}, offset: {}{}{}}}", scale.gain, scale.offset,
                     scale.has_exponent() ? ", exponent_of: " : "", scale.exponent_of);
}

void add_format(const Point& point, Cells& cells) {
  const codec::Format& format = point.format;
  cells["type"] = to_string(format.type);
  if (format.type == codec::Type::STRING) {
    cells["length"] = fmt::to_string(format.length);
    if (format.encoding != codec::Encoding::utf8) cells["encoding"] = codec::to_string(format.encoding);
    if (codec::ignores_byte_order(format)) cells["order"] = "AB";
    return;
  }
  const unsigned width = codec::width(format.type);
  if (format.type == codec::Type::BOOL) cells["bit"] = fmt::to_string(format.bit);
  if (width == 8 && format.bits == 0) cells["offset"] = codec::to_string(format.half);
  if (width > 16 || codec::bytes_swapped(format.order))
    cells["order"] = codec::to_string(format.order, width <= 16);
  if (point.scale.present()) cells["scale"] = scale_text(point.scale);
}

/// From the model: the map's own keys (addressing, orders, preset) are worked in.
Cells cells_of(const Point& point) {
  Cells cells;
  cells["table"] = to_string(point.table);
  cells["name"] = point.name;
  cells["address"] = fmt::to_string(point.address);
  if (!holds_bits(point.table)) add_format(point, cells);
  if (point.count > 1) cells["count"] = fmt::to_string(point.count);
  const Access usual = is_writable(point.table) ? Access::read_write : Access::read;
  if (point.access != usual) cells["access"] = to_string(point.access);
  if (point.read_address) cells["read_address"] = fmt::to_string(*point.read_address);
  cells["units"] = point.units;
  cells["description"] = point.description;
  return cells;
}

/// Returns whether keys about the subject have a meaning for the point.
bool applies(About about, const Point& point) {
  if (about == About::reading) return is_readable(point);
  return about != About::writing || is_writable(point);
}

/// From the model, too: `defaults` are worked in.
void add_host_options(const Point& point, const Entry* defaults, Cells& cells) {
  HostOptions host = point.host;
  if (host.publish != HostOptions::Publish::on_change) {  // `defaults` may have what goes with it
    host.deadband = 0;
    host.max_interval = {};
  }
  for_each_field(host, HostOptions{}, [&](const auto& field, const auto& value, const auto& usual) {
    if (value != usual && applies(field.about, point)) cells[std::string(field.key)] = written(value);
  });
  const Entry* deadman = defaults != nullptr ? loader::child(*defaults, "deadman") : nullptr;
  if (is_writable(point) && host.deadman.present() && deadman != nullptr) cells["deadman"] = flow(*deadman);
}

/// The rest, and a deadman of the point's own, as it stands in the file.
void add_file_keys(const Entry& entry, Cells& cells) {
  std::set<std::string_view> from_model{
      "address",          "type",  "order", "offset", "bit",          "length", "encoding",
      "ignore_byteorder", "count", "scale", "access", "read_address", "units",  "description"};
  const HostOptions host;
  for_each_field(host, [&](const auto& field, const auto&) { from_model.insert(field.key); });
  for (const Entry& option : entry.children)
    if (from_model.count(option.key) == 0)
      cells[option.key] = option.kind == Entry::Kind::scalar ? option.text : flow(option);
}

using EntriesByName = std::unordered_map<std::string_view, const Entry*>;

/// The points as they stand in the file.
EntriesByName entries_of(const Entry& root) {
  EntriesByName entries;
  if (const Entry* mapping = loader::child(root, "mapping"))
    for (const Entry& table : mapping->children)
      for (const Entry& point : table.children) entries.emplace(point.key, &point);
  return entries;
}

/// In the order of the key table.
std::vector<std::string> columns_of(const std::vector<Cells>& rows) {
  std::vector<std::string> columns(std::begin(exported_columns), std::end(exported_columns));
  for (const loader::Key& key : loader::all_keys()) {
    const bool used =
        std::any_of(rows.begin(), rows.end(), [&](const Cells& cells) { return cells.count(key.name) > 0; });
    if (used && std::find(columns.begin(), columns.end(), key.name) == columns.end())
      columns.emplace_back(key.name);
  }
  return columns;
}

/// `coupler import csv` adds on_shutdown again, since a point without hardware has a safe value.
bool implies_on_shutdown(const Map& map, const EntriesByName& entries) {
  return std::any_of(map.points.begin(), map.points.end(), [&](const Point& point) {
    const auto entry = entries.find(point.name);
    return !point.line.present() && !is_analogue(point) && entry != entries.end() &&
           loader::child(*entry->second, "safe") != nullptr;
  });
}

bool holds_text(std::string_view column, const Point& point) {
  const loader::Key* key = loader::find_key(column, loader::section_of(point.table));
  return key != nullptr && is_text(*key, point.format.type == codec::Type::STRING);
}

void warn_of_device_keys(const Entry& root, bool with_on_shutdown, ConversionWarnings& warnings) {
  std::set<std::string_view> worked_in{"mapping", "defaults", "addressing", "byteorder_reverse",
                                       "wordorder_reverse"};
  if (with_on_shutdown) worked_in.insert("on_shutdown");
  for (const Entry& entry : root.children)
    if (worked_in.count(entry.key) == 0)
      warnings.add("the table has points only, the device's keys are left out",
                   "write them into the map that is made from it; `coupler import` takes --name and --unit",
                   entry.key);
}

}  // namespace

Export write_csv(const Map& map) {
  Export out;
  loader::Problems ignored("");  // the loader has read the text before
  const auto root = loader::parse_document(map.text, ignored);
  const EntriesByName entries = root ? entries_of(*root) : EntriesByName{};
  std::vector<Cells> rows;
  for (const Point& point : map.points) {
    rows.push_back(cells_of(point));
    add_host_options(point, root ? loader::child(*root, "defaults") : nullptr, rows.back());
    if (const auto entry = entries.find(point.name); entry != entries.end())
      add_file_keys(*entry->second, rows.back());
  }
  if (root) warn_of_device_keys(*root, implies_on_shutdown(map, entries), out.warnings);
  const std::vector<std::string> columns = columns_of(rows);
  out.text = fmt::format("{}\r\n", fmt::join(columns, ","));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::string line;
    for (const std::string& column : columns) {
      if (!line.empty()) line += ',';
      if (const auto found = rows[i].find(column); found != rows[i].end())
        line += csv_cell(holds_text(column, map.points[i]) ? guarded(found->second) : found->second);
    }
    out.text += line + "\r\n";
  }
  return out;
}

}  // namespace coupler::formats
