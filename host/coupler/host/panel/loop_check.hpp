// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "coupler/host/panel/word_bits.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// What was seen of a point, or of a bit, since the start.
struct Seen {
  bool off;
  bool on;
  std::uint64_t changes;
};

/// The first line of a loop check: CSV (RFC 4180), as the others.
std::string loop_check_head();
/// The line of a point; then one for each of its bits, named "status.3", if it has any.
std::string loop_check_lines(const Point& point, const Seen& seen, const WordBits* bits);

}  // namespace coupler::host
