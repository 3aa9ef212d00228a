// SPDX-License-Identifier: Apache-2.0
// The registers that pymodbus' simulator builds from a device of its configuration, cell by cell: what is
// defined, repeated and opened for writing is only known when all is done.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/map/loader/document.hpp"
#include "coupler/map/loader/problems.hpp"
#include "coupler/map/table.hpp"
#include "coupler/tools/formats/exporters.hpp"

namespace coupler::formats {

/// A type of the simulator, and what it is in a map.
struct SimulatedType {
  std::string_view key;
  unsigned registers;  ///< 0: as many as are given
  std::string_view iec;
};

struct SimulatedCell {
  const SimulatedType* type = nullptr;  ///< nullptr: no value begins here
  bool continues = false;               ///< of the value that begins before
  bool writable = false;
  unsigned definition = 0;  ///< cells of one entry of the file, or of one repetition of it, have the same
  std::string value;
  loader::Position at;
};

/// A value, or several alike one behind the other.
struct SimulatedValue {
  const SimulatedType* type = nullptr;
  unsigned first = 0;  ///< cell
  unsigned count = 1;
  unsigned registers = 1;  ///< of each
  bool writable = false;
  std::string value;
  loader::Position at;
};

/// The place of a cell in the tables.
struct SimulatedPlace {
  Table table;
  unsigned address;  ///< of its register or of its first bit
};

class SimulatedMemory {
 public:
  /// Reads `setup`, the types, `write` and `repeat`, as pymodbus does.
  SimulatedMemory(const loader::Entry& device, ConversionWarnings& losses, loader::Problems& problems);

  /// In the order of their addresses.
  std::vector<SimulatedValue> values() const;

  bool shared() const { return shared_; }
  /// In blocks of their own the cells of the coils come first, then discrete inputs, input registers and
  /// holding registers. In a shared block all tables show all cells; bits are taken for coils or, if they
  /// cannot be written, for discrete inputs, the rest, and bits that no request reaches, for holding
  /// registers.
  SimulatedPlace place_of(const SimulatedValue& value) const;
  /// The cells that stand in one table with this one end here.
  unsigned table_end(unsigned cell) const;

 private:
  void read_setup(const loader::Entry& device);
  void define(const SimulatedType& type, const loader::Entry& entry);
  void allow_writing(const loader::Entry& device);
  void repeat(const loader::Entry& device);
  /// First and last cell; false, with an error, if they are none.
  bool read_range(const loader::Entry& given, unsigned& first, unsigned& last) const;
  void lose_action(const SimulatedType& type, const loader::Entry& action);

  const loader::Entry* default_of(std::string_view what, std::string_view type) const;

  ConversionWarnings& losses_;
  loader::Problems& problems_;
  const loader::Entry* defaults_ = nullptr;
  bool shared_ = false;
  unsigned ends_[4] = {};  ///< of the tables, in the order of `tables`
  unsigned definitions_ = 0;
  std::vector<SimulatedCell> cells_;
};

}  // namespace coupler::formats
