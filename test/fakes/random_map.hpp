// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "coupler/map/map.hpp"

namespace coupler::fakes {

/// Valid maps as YAML, the same for the same seed on every machine: all tables, types and orders, gaps,
/// arrays, parts of registers, texts, scales, initial values, what the host does with a point.
///   RandomMap map(7);  load_map(map.yaml(), "random.yaml")
class RandomMap {
 public:
  explicit RandomMap(std::uint32_t seed, unsigned most_points_a_table = 12);

  /// GPIO lines with safe states, wires of the simulated chip, counters, latches.
  void add_hardware();
  /// Points without address, which a lock beside the map gives them, and reserved areas.
  void leave_out_addresses();

  std::string yaml() const;

  /// Changes one thing; what was changed, for messages of tests. The map stays valid but for points that may
  /// now overlap or end past 65535.
  std::string edit();

 private:
  /// A point: what the map says of it, but for its place, ready to be written.
  struct Row {
    std::string name;
    Table table;
    std::optional<std::uint32_t> address;
    std::uint32_t size;   ///< addresses
    std::string part;     ///< ", bit: 3" or ", offset: high"
    std::string format;   ///< ", type: INT, order: BA"
    std::string options;  ///< ", units: mm"
  };

  std::uint32_t below(std::uint32_t end);
  bool one_in(std::uint32_t n) { return below(n) == 0; }
  void add_bits(Table table);
  void add_registers(Table table);
  std::uint32_t add_shared(Table table, std::uint32_t address);
  std::uint32_t format(std::string& text);
  std::string options(Table table, bool scalable);
  std::string head();
  void add_initial(Row& row);
  static std::string keys_of(const Row& row);
  std::vector<Row*> single_bits(Table table);
  void add_counters(const std::string& input);

  std::mt19937 random_;  // its numbers are the standard's, those of its distributions are not
  unsigned most_points_;
  unsigned names_ = 0;
  std::string head_;
  std::string tail_;
  std::vector<Row> rows_;
};

}  // namespace coupler::fakes
