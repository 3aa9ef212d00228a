// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "coupler/host/panel/history.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// Returns the number of bits that a page shows of a point, one by one: those of a BYTE, WORD, DWORD or
/// LWORD, or of the part of it that the point has. 0: it is none, or an array, or cannot be read.
unsigned bits_of(const Point& point);

/// The bits that a word had in a step. A bit in neither is not known.
struct BitsStep {
  std::uint64_t on = 0;
  std::uint64_t off = 0;

  void add(const BitsStep& value) {
    on |= value.on;
    off |= value.off;
  }
};

/// The bits of a word, as a page shows each: what it is, whether it was on and off, how often it has changed,
/// and its last ten minutes. Numbers of bits in JSON are hexadecimal texts, since JavaScript's have 53 bits.
class WordBits {
 public:
  explicit WordBits(unsigned count) : changes_(count) {}

  void take(std::uint64_t word, Time at);
  void lose(Time at) { history_.lose(at); }
  void advance(Time now) { history_.advance(now); }

  unsigned count() const { return static_cast<unsigned>(changes_.size()); }
  bool was_on(unsigned bit) const { return (seen_.on >> bit & 1) != 0; }
  bool was_off(unsigned bit) const { return (seen_.off >> bit & 1) != 0; }
  std::uint64_t changes(unsigned bit) const { return changes_[bit]; }

  /// {"is": "8005", "on": …, "off": …, "changes": […]}; without "is" there is no value yet.
  nlohmann::ordered_json json() const;
  const StepHistory<BitsStep>& history() const { return history_; }

 private:
  std::optional<std::uint64_t> word_;  ///< the last one
  BitsStep seen_;
  std::vector<std::uint64_t> changes_;
  StepHistory<BitsStep> history_;
};

}  // namespace coupler::host
