// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "coupler/codec/format.hpp"
#include "coupler/host/scan/known_value.hpp"
#include "coupler/host/scan/table_findings.hpp"

namespace coupler::scan {

/// A place where a known value stands.
struct Candidate {
  Table table;
  modbus::Range range;
  codec::Type type;
  codec::Order order;
  int divisor;    ///< 1, 10 or 100: the register holds the value times that
  double value;   ///< as it was read
  double chance;  ///< that registers of any content match as well: the less, the better the candidate
};

/// The places where `known` stands as UINT, INT, UDINT, DINT (also in tenths and hundredths), REAL or LREAL
/// in one of the four orders, best first. What is not negative shows no sign: it is found as UINT, not as INT
/// too.
std::vector<Candidate> find_candidates(const KnownValue& known, const std::vector<TableFindings>& tables);

/// The one order of the whole device: each of `found` (the candidates of one known value each; empty ones do
/// not count) has in it a candidate that is no worse than its best one. nullopt: they disagree, or none has
/// more than one register.
std::optional<codec::Order> common_order(const std::vector<std::vector<Candidate>>& found);

/// The best one that stands in `order`, if that is given; nullptr if there is none.
const Candidate* choose(const std::vector<Candidate>& candidates, std::optional<codec::Order> order);

}  // namespace coupler::scan
