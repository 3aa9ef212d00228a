// SPDX-License-Identifier: Apache-2.0
// The plan in words: those of Modbus and of the map's keys.
#pragma once

#include <string>

#include "coupler/plan/planner.hpp"

namespace coupler::plan {

/// The address as Modicon documents write it, counted from 1 behind the table's digit: "40001", and six
/// digits
/// ("410000") where five do not suffice.
std::string modicon(Table table, std::uint32_t address);

/// "gap", "other_rate" …: a word for programs.
std::string_view to_string(Cut::Reason reason);
/// The key of the map that would let the request go on; empty if there is none.
std::string_view key_of(Cut::Reason reason, Table table);
/// Why `span` ends, for people: "12 addresses lie before level, the gap is 12
/// (registers_read_separation_gap)".
std::string explain_end(const ReadSpan& span, const Map& map);

/// "write_only" …
std::string_view to_string(NotRead reason);
/// The same for people: "too long for one reply".
std::string_view words_of(NotRead reason);

}  // namespace coupler::plan
