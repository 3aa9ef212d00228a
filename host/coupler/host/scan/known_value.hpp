// SPDX-License-Identifier: Apache-2.0
// Values that somebody knows, and where they stand in a device's registers.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "coupler/codec/format.hpp"
#include "coupler/host/scan/table_scan.hpp"

namespace coupler::scan {

/// A value that the device displays, and so has somewhere in its registers.
struct KnownValue {
  std::string name;  ///< of the point; may be empty
  double value = 0;
  double tolerance = 0;
};

/// "230.4", "voltage=230.4", "voltage=230.4±2" ("+-" means the same). A value without a tolerance is as exact
/// as it is written: 230.4 is 230.35 … 230.45. Errors: no number; a name that no point can have; a value that
/// may be 0, which is found everywhere.
tl::expected<KnownValue, std::string> parse_known_value(std::string_view text);

/// A place where a known value was found.
struct Candidate {
  Table table;
  modbus::Range range;
  codec::Type type;
  codec::Order order;
  int divisor;    ///< 1, 10 or 100: the register holds the value times that
  double value;   ///< as it was read
  double chance;  ///< that registers of any content match: the smaller, the better the candidate
};

/// The places where `known` is found as UINT, INT, UDINT, DINT (also in tenths and hundredths), REAL or LREAL
/// in one of the four orders, best first. What is not negative shows no sign: it is found as UINT, not as INT
/// too.
std::vector<Candidate> find_candidates(const KnownValue& known, const std::vector<TableFindings>& tables);

/// The best one, in `order` if that is given; nullptr if there is none.
const Candidate* choose(const std::vector<Candidate>& candidates, std::optional<codec::Order> order);

/// A known value and where it was found, best first.
struct Match {
  KnownValue known;
  std::vector<Candidate> candidates;
};

/// The one order of the whole device: each match (those without candidates do not count) has in it a
/// candidate that is no worse than its best one. nullopt: they disagree, or none has more than one register.
std::optional<codec::Order> common_order(const std::vector<Match>& matches);

}  // namespace coupler::scan
