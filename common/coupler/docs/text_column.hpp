// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace coupler::docs {

/// A column of a table of descriptions, each of which is one row.
template <class Description>
struct TextColumn {
  std::string_view title;
  std::string Description::*text;
};

/// Those that one of the rows fills. Tables have columns_of(const Description*), the first of which is the
/// name.
template <class Description>
std::vector<TextColumn<Description>> used_columns(const std::vector<Description>& rows) {
  std::vector<TextColumn<Description>> used;
  for (const TextColumn<Description>& column : columns_of(static_cast<const Description*>(nullptr)))
    if (std::any_of(rows.begin(), rows.end(),
                    [&](const Description& row) { return !(row.*column.text).empty(); }))
      used.push_back(column);
  return used;
}

}  // namespace coupler::docs
