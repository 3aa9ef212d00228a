// SPDX-License-Identifier: Apache-2.0
#include "coupler/formats/entries.hpp"

#include <algorithm>
#include <utility>

namespace coupler::formats {

using loader::Entry;
using loader::Position;

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

const Entry* find(const Entry& parent, std::string_view key) {
  const auto found = std::find_if(parent.children.begin(), parent.children.end(),
                                  [key](const Entry& child) { return child.key == key; });
  return found == parent.children.end() ? nullptr : &*found;
}

Entry* find(Entry& parent, std::string_view key) {
  return const_cast<Entry*>(find(std::as_const(parent), key));
}

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

}  // namespace coupler::formats
