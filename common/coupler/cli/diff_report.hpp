// SPDX-License-Identifier: Apache-2.0
// What `coupler diff` says. docs/diff.md holds the JSON's fields.
#pragma once

#include <string>
#include <vector>

#include "coupler/changes/changes.hpp"

namespace coupler::cli {

/// The two maps as the user named them.
struct Versions {
  std::string older;
  std::string newer;
};

/// A line for each change, the worst severity first, and one that counts them.
std::string diff_text(const Versions& versions, const std::vector<changes::Change>& changes);

/// One line.
std::string diff_json(const Versions& versions, const std::vector<changes::Change>& changes);

/// A table for each severity that there is, for reviews.
std::string diff_markdown(const Versions& versions, const std::vector<changes::Change>& changes);

}  // namespace coupler::cli
