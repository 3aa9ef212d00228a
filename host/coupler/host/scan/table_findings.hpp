// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "coupler/map/table.hpp"
#include "coupler/modbus/range.hpp"

namespace coupler::scan {

/// What is known of one table.
class TableFindings {
 public:
  TableFindings(Table table, modbus::Range window);

  Table table() const { return table_; }
  /// The addresses that were to be looked at.
  modbus::Range window() const { return window_; }

  enum class Seen : std::uint8_t { not_asked, readable, refused };
  Seen seen(std::uint32_t address) const { return seen_[address - window_.start()]; }
  /// Of a readable address; a bit is 0 or 1.
  std::uint16_t value(std::uint32_t address) const { return values_[address - window_.start()]; }

  void add_values(modbus::Range range, const std::uint16_t* values);
  void add_refused(std::uint32_t address) { seen_[address - window_.start()] = Seen::refused; }
  /// Both sides of `address` can be read, but not in one request.
  void add_seam(std::uint32_t address) { seams_.insert(address); }

  std::uint32_t count(Seen seen) const;
  /// What can be read: addresses that follow each other, cut at the seams.
  std::vector<modbus::Range> readable() const;
  /// Addresses between readable ones that were all refused.
  std::vector<modbus::Range> holes() const;
  const std::set<std::uint32_t>& seams() const { return seams_; }

  bool absent = false;                      ///< the device has no function that reads it (exception 01)
  std::optional<std::uint32_t> gave_up_at;  ///< it stayed silent too often

 private:
  Table table_;
  modbus::Range window_;
  std::vector<Seen> seen_;
  std::vector<std::uint16_t> values_;
  std::set<std::uint32_t> seams_;
};

}  // namespace coupler::scan
