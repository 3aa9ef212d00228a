// SPDX-License-Identifier: Apache-2.0
// The tree that the loader makes of a map: how importers build it, and how it is written as YAML.
#pragma once

#include <string>
#include <string_view>

#include "coupler/map/loader/document.hpp"

namespace coupler::formats {

/// `quoted`: a text, even if it looks like a number.
loader::Entry scalar(std::string_view key, std::string text, loader::Position at, bool quoted = false);

loader::Entry section(std::string_view key, loader::Position at);

/// Does what loader::child() does, for a node that will be changed.
loader::Entry* find(loader::Entry& parent, std::string_view key);

/// The section of that key, added at the end if it is not there.
loader::Entry& make_section(loader::Entry& parent, std::string_view key, loader::Position at);

/// In place of the child with the same key, or at the end.
void set(loader::Entry& parent, loader::Entry child);

/// Removes the child with that key, if there is one.
void drop(loader::Entry& parent, std::string_view key);

/// The tree of a map as a YAML file in this project's style: the device's keys in the order of the key table,
/// then `mapping:` with one line a point; words of choices as the documentation spells them. Keys that no map
/// has, and tables without points, are left out. `comment` is the first line.
std::string write_map(const loader::Entry& map, std::string_view comment);

/// A value as it may stand in one line of YAML, inside brackets or not: 5, "two words", {of: pulse}.
std::string flow(const loader::Entry& value);

}  // namespace coupler::formats
