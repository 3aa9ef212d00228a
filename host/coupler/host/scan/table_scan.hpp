// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "coupler/host/scan/prober.hpp"
#include "coupler/map/table.hpp"
#include "coupler/modbus/limits.hpp"
#include "coupler/modbus/range.hpp"

namespace coupler::scan {

/// The result for one table.
class TableFindings {
 public:
  TableFindings(Table table, modbus::Range window);

  Table table() const { return table_; }
  /// The addresses that were to be looked at.
  modbus::Range window() const { return window_; }

  enum class Seen : std::uint8_t { not_asked, readable, refused };
  Seen seen(std::uint32_t address) const { return seen_[address - window_.start()]; }
  /// Returns the value of a readable address; a bit is 0 or 1.
  std::uint16_t value(std::uint32_t address) const { return values_[address - window_.start()]; }

  void add_values(modbus::Range range, const std::uint16_t* values);
  void add_refused(std::uint32_t address) { seen_[address - window_.start()] = Seen::refused; }
  /// Both sides of `address` can be read, but not in one request.
  void add_seam(std::uint32_t address) { seams_.insert(address); }

  std::uint32_t count(Seen seen) const;
  /// Returns the ranges that can be read: addresses that follow each other, cut at the seams.
  std::vector<modbus::Range> readable() const;
  /// Addresses between readable ones that were all refused.
  std::vector<modbus::Range> holes() const;
  const std::set<std::uint32_t>& seams() const { return seams_; }

  bool absent = false;                      ///< the device has no function that reads it (exception 01)
  std::optional<std::uint32_t> gave_up_at;  ///< too many requests had no reply

 private:
  Table table_;
  modbus::Range window_;
  std::vector<Seen> seen_;
  std::vector<std::uint16_t> values_;
  std::set<std::uint32_t> seams_;
};

/// The limit of one read, in bits or registers.
struct Largest {
  std::uint32_t count;      ///< no more is asked for
  bool is_limited = false;  ///< the device refuses more; the protocol would allow it
};
struct LargestReads {
  Largest bits{modbus::max_read_bits};
  Largest registers{modbus::max_read_registers};

  Largest& of(Table table) { return holds_bits(table) ? bits : registers; }
};

/// If whole blocks are refused, so many addresses from the first one on are all tried.
constexpr std::uint32_t first_addresses = 100;
/// This far around a readable address all are tried.
constexpr std::uint32_t neighbourhood = 16;
/// After so many time-outs the rest of a table is left alone: each costs a timeout.
constexpr int most_timeouts = 50;

/// Finds out which addresses of a table can be read, with few requests:
/// 1. Blocks, as large as a request may be. One that can be read needs nothing more.
/// 2. In a block that is refused: the first addresses of the window, then one address in `stride`, and each
///    multiple of 100 and the address after it, where the tables of manuals tend to begin.
/// 3. Around each address that can be read: all, in the largest pieces that can be read, until
/// `neighbourhood`
///    addresses in a row are refused.
/// A read that is refused though its addresses can be read one by one shows either the largest count that the
/// device takes (the same count is given one address further) or a seam that no read may cross.
class TableScan {
 public:
  /// `stride` 1: every address is tried.
  TableScan(Prober& prober, ScanProgress& progress, LargestReads& largest, std::uint32_t stride,
            TableFindings& findings);

  /// False if the scan has to end: what was found so far is in the findings.
  bool run();

 private:
  using Seen = TableFindings::Seen;

  bool reads(modbus::Range range);
  bool reads(std::uint32_t start, std::uint32_t count) { return reads(modbus::Range::of(start, count)); }
  bool is_readable(std::uint32_t address);
  void look_at(modbus::Range block);
  bool try_some(modbus::Range block);
  bool is_tried(std::uint32_t address) const;
  void look_around();
  std::vector<modbus::Range> surroundings() const;
  void walk(modbus::Range range);
  std::uint32_t extend(std::uint32_t start, std::uint32_t end);
  void explain(std::uint32_t start, std::uint32_t count, std::uint32_t end);
  bool ended() const { return over_ || findings_.absent || findings_.gave_up_at; }

  Prober& prober_;
  ScanProgress& progress_;
  Largest& largest_;
  std::uint32_t stride_;
  TableFindings& findings_;
  std::array<std::uint16_t, modbus::max_read_bits> values_{};
  int timeouts_ = 0;
  bool over_ = false;
};

}  // namespace coupler::scan
