// SPDX-License-Identifier: Apache-2.0
// The text of Home Assistant's configuration as a tree: what is there besides YAML, and what is not read.
#pragma once

#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "coupler/map/loader/document.hpp"
#include "coupler/map/loader/problems.hpp"

namespace coupler::formats {

/// The lines and columns of values with a tag, as `!secret` and `!include`.
using TagPlaces = std::set<std::pair<int, int>>;

struct HomeAssistantFile {
  std::vector<loader::Entry> parts;        ///< what stands below each `modbus:`, or the whole file
  TagPlaces tags;                          ///< in the parts, which have plain text in their place
  std::vector<loader::Position> old_form;  ///< each "platform: modbus"
};

/// nullopt, with the reason in the problems, if the parts are not YAML.
std::optional<HomeAssistantFile> read_home_assistant_file(std::string_view text, loader::Problems& problems);

/// A secret is left out with a warning; what stands in other files is an error.
void take_tags_out(loader::Entry& entry, const TagPlaces& tags, loader::Problems& problems);

/// The name of the secret that stands in place of the value, as "NAME" of "!secret NAME"; empty if none does.
/// Only of the keys that say which place of which device is meant; other secrets are left out.
std::string_view secret_of(const loader::Entry& entry);

}  // namespace coupler::formats
