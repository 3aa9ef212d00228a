// SPDX-License-Identifier: Apache-2.0
#include "test/fakes/random_map.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace coupler::fakes {

/// Those that a line may be behind.
std::vector<RandomMap::Row*> RandomMap::single_bits(Table table) {
  std::vector<Row*> found;
  for (Row& row : rows_)
    if (row.table == table && row.size == 1) found.push_back(&row);
  return found;
}

void RandomMap::add_counters(const std::string& input) {
  for (const Table table : {Table::input_registers, Table::holding_registers})
    rows_.push_back({fmt::format("p{}", names_++), table, 50000 + below(1000), 1, "",
                     fmt::format(", type: UINT, counter: {{of: {}, edge: both}}", input), ""});
}

void RandomMap::add_hardware() {
  unsigned lines = 0;
  const auto line = [&lines] { return fmt::format(", line: {{chip: gpiochip0, offset: {}}}", lines++); };
  std::string wires;
  std::string counted;  // an input that is not wired: its edges come from nowhere
  std::vector<Row*> inputs = single_bits(Table::discrete_inputs);
  for (Row* input : inputs) {
    input->options += line();
    if (one_in(2)) input->options += one_in(2) ? ", bias: pull_up" : ", active_low: true, debounce: 5ms";
    if (counted.empty() && one_in(2)) {
      counted = input->name;
    } else if (one_in(4)) {
      wires += fmt::format("  - {{to: {}, square: 1s}}\n", input->name);
    }
  }
  for (Row* coil : single_bits(Table::coils)) {
    if (!counted.empty() && one_in(4)) {
      coil->options += fmt::format(", latched: {{of: {}, edge: falling}}", counted);
    } else if (one_in(2)) {
      coil->options += line();
      if (one_in(2)) coil->options += one_in(2) ? ", safe: on" : ", safe: hold, drive: open_drain";
    }
  }
  if (!counted.empty()) add_counters(counted);
  if (!wires.empty()) tail_ += "sim:\n" + wires;
}

void RandomMap::leave_out_addresses() {
  std::uint32_t free = 10;  // holding registers before the first that has an address
  for (Row& row : rows_) {
    if (row.part.empty() && one_in(2)) row.address.reset();
    if (row.table == Table::holding_registers && row.address) free = std::min(free, *row.address);
  }
  if (free > 0)
    head_ += fmt::format("reserve: [{{table: holding_registers, from: 0, to: {}}}]\n", below(free));
}

}  // namespace coupler::fakes
