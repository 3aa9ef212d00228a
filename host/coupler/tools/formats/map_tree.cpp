// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/map_tree.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coupler/map/loader/keys.hpp"
#include "coupler/map/loader/scalar.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::Key;
using loader::Position;
using loader::Section;

bool is_plain_character(char c) {
  return loader::is_letter(c) || loader::is_digit(c) ||
         std::string_view("_./+-").find(c) != std::string_view::npos;
}

/// Reads back as the same characters wherever it stands, and is not YAML's null.
bool is_plain(std::string_view text) {
  if (text.empty() || !std::all_of(text.begin(), text.end(), is_plain_character)) return false;
  const bool is_number = text.size() > 1 && loader::is_digit(text[1]);
  const bool begins_plain = loader::is_letter(text[0]) || loader::is_digit(text[0]) || text[0] == '/';
  return (begins_plain || is_number) && lower(text) != "null";
}

/// Can only be text, with quotes or without.
bool is_word(std::string_view text) {
  return text[0] == '/' ||
         (loader::is_letter(text[0]) && !loader::parse_boolean(text) && !loader::parse_number(text));
}

std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    switch (c) {
      case '"': out += "\\\""; break;
      case '\\': out += "\\\\"; break;
      case '\n': out += "\\n"; break;
      case '\r': out += "\\r"; break;
      case '\t': out += "\\t"; break;
      default:
        if (static_cast<unsigned char>(c) < 0x20 || c == '\x7F')
          out += fmt::format("\\x{:02X}", static_cast<unsigned char>(c));
        else
          out += c;
    }
  }
  return out + '"';
}

std::string key_text(std::string_view key) { return is_plain(key) ? std::string(key) : in_quotes(key); }

/// Choices in the documentation's spelling: ros-modbus-device-driver takes any case.
std::string value_text(const Entry& entry, const Key* key) {
  if (key != nullptr && entry.kind == Entry::Kind::scalar)
    for (const std::string_view word : loader::words(key->choices))
      if (lower(word) == lower(entry.text)) return std::string(word);
  return flow(entry);
}

/// `lamp: {address: 0}` is `lamp: 0` where a bare number is enough.
bool is_bare(const Entry& point, Section table) {
  return point.children.size() == 1 && point.children[0].key == "address" &&
         overlap(table, Section::coil | Section::discrete_input);
}

std::string point_text(const Entry& point, Section table) {
  if (point.kind != Entry::Kind::map) return flow(point);
  if (is_bare(point, table)) return flow(point.children[0]);
  std::string out;
  for (const Entry& option : point.children)
    if (const Key* key = loader::find_key(option.key, table))
      out += fmt::format("{}{}: {}", out.empty() ? "" : ", ", option.key, value_text(option, key));
  return "{" + out + "}";
}

std::string table_text(const Entry& entry, Table table) {
  std::string out = fmt::format("  {}:\n", to_string(table));
  for (const Entry& point : entry.children)
    out += fmt::format("    {}: {}\n", key_text(point.key), point_text(point, loader::section_of(table)));
  return out;
}

std::string mapping_text(const Entry* mapping) {
  std::string out;
  if (mapping != nullptr)
    for (const Table table : tables)
      if (const Entry* entry = loader::child(*mapping, to_string(table));
          entry != nullptr && !entry->children.empty())
        out += table_text(*entry, table);
  return out.empty() ? "mapping: {}\n" : "mapping:\n" + out;
}

}  // namespace

Entry scalar(std::string_view key, std::string text, Position at, bool quoted) {
  Entry entry;
  entry.key = key;
  entry.key_at = at;
  entry.kind = Entry::Kind::scalar;
  entry.at = at;
  entry.text = std::move(text);
  entry.quoted = quoted;
  return entry;
}

Entry section(std::string_view key, Position at) {
  Entry entry;
  entry.key = key;
  entry.key_at = at;
  entry.kind = Entry::Kind::map;
  entry.at = at;
  return entry;
}

Entry* find(Entry& parent, std::string_view key) { return const_cast<Entry*>(loader::child(parent, key)); }

Entry& make_section(Entry& parent, std::string_view key, Position at) {
  if (Entry* found = find(parent, key)) return *found;
  return parent.children.emplace_back(section(key, at));
}

void set(Entry& parent, Entry child) {
  if (Entry* found = find(parent, child.key))
    *found = std::move(child);
  else
    parent.children.push_back(std::move(child));
}

void drop(Entry& parent, std::string_view key) {
  if (const Entry* found = loader::child(parent, key))
    parent.children.erase(parent.children.begin() + (found - parent.children.data()));
}

std::string flow(const Entry& value) {
  if (value.kind == Entry::Kind::null) return "null";
  if (value.kind == Entry::Kind::scalar)
    return is_plain(value.text) && (!value.quoted || is_word(value.text)) ? value.text
                                                                          : in_quotes(value.text);
  const bool is_map = value.kind == Entry::Kind::map;
  std::string out;
  for (const Entry& child : value.children) {
    if (!out.empty()) out += ", ";
    if (is_map) out += key_text(child.key) + ": ";
    out += flow(child);
  }
  return is_map ? "{" + out + "}" : "[" + out + "]";
}

std::string write_map(const Entry& map, std::string_view comment) {
  std::string out = fmt::format("# {}\n", comment);
  for (const Key& key : loader::all_keys()) {
    if (!overlap(key.sections, Section::map) || key.name == "mapping") continue;
    const std::string_view name = key.same_as.empty() ? key.name : key.same_as;
    if (const Entry* entry = loader::child(map, key.name))
      out += fmt::format("{}: {}\n", name, value_text(*entry, &key));
  }
  return out + mapping_text(loader::child(map, "mapping"));
}

}  // namespace coupler::formats
