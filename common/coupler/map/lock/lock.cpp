// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/lock/lock.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace coupler::lock {

Names::Names(const Lock& lock) {
  for (const Entry& entry : lock) of_table_[index(entry.place.table)].emplace(entry.name, &entry);
}

const Entry* Names::find(Table table, std::string_view name) const {
  const auto& names = of_table_[index(table)];
  const auto found = names.find(name);
  return found == names.end() ? nullptr : found->second;
}

bool equal(const Lock& a, const Lock& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Entry& x, const Entry& y) {
    return x.place == y.place && x.name == y.name && x.retired == y.retired;
  });
}

std::string print(const Lock& lock) {
  std::string text =
      "# The addresses that `coupler` gave to the points of the map beside this file that leave theirs out.\n"
      "# It belongs into version control, and goes wherever the map goes. `coupler check MAP` writes it. An\n"
      "# address once given never moves; that of a retired point is given to no other while its line is "
      "here.\n";
  text += fmt::format("{}\n", first_line);
  for (const Entry& entry : lock)
    text += fmt::format("{} {}{}\n", to_string(entry.place), entry.name, entry.retired ? " retired" : "");
  return text;
}

}  // namespace coupler::lock
