// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/aliases.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coupler/map/loader/syntax_error.hpp"

namespace coupler::loader {
namespace {

std::size_t bytes_of(const Entry& value) {
  std::size_t bytes = sizeof(Entry) + value.key.size() + value.text.size();
  for (const Entry& child : value.children) bytes += bytes_of(child);
  return bytes;
}

void merge_one(Entry& from, Entry& into, std::set<std::string>& taken) {
  if (from.kind != Entry::Kind::map)
    throw SyntaxError{from.at, "a merge key ('<<') needs a map",
                      "write '<<: *NAME', where '&NAME' stands before a map"};
  for (Entry& child : from.children)
    if (taken.insert(child.key).second) into.children.push_back(std::move(child));
}

}  // namespace

bool Anchors::make_room_for(const Entry& value) {
  const std::size_t bytes = bytes_of(value);
  if (bytes > room_) return false;
  room_ -= bytes;
  return true;
}

bool Anchors::keep(std::size_t anchor, const Entry& value) {
  return make_room_for(value) && values_.insert_or_assign(anchor, value).second;
}

const Entry* Anchors::find(std::size_t anchor) const {
  const auto found = values_.find(anchor);
  return found == values_.end() ? nullptr : &found->second;
}

std::size_t depth_of(const Entry& value) {
  std::size_t deepest = 0;
  for (const Entry& child : value.children) deepest = std::max(deepest, depth_of(child));
  return deepest + (value.kind == Entry::Kind::list || value.kind == Entry::Kind::map ? 1 : 0);
}

void merge_keys(Entry& map) {
  const auto is_merge = [](const Entry& entry) { return entry.key == "<<"; };
  if (map.kind != Entry::Kind::map || std::none_of(map.children.begin(), map.children.end(), is_merge))
    return;
  const auto first_merge = std::stable_partition(map.children.begin(), map.children.end(),
                                                 [&](const Entry& entry) { return !is_merge(entry); });
  std::vector<Entry> merges(std::make_move_iterator(first_merge),
                            std::make_move_iterator(map.children.end()));
  map.children.erase(first_merge, map.children.end());
  std::set<std::string> taken;
  for (const Entry& own : map.children) taken.insert(own.key);
  for (Entry& merge : merges) {
    if (merge.kind != Entry::Kind::list) {
      merge_one(merge, map, taken);
      continue;
    }
    for (Entry& each : merge.children) merge_one(each, map, taken);
  }
}

}  // namespace coupler::loader
