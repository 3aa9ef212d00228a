// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "host/survey/inquiry.hpp"

namespace coupler::survey {

struct UnitAnswer {
  std::uint8_t unit;
  std::optional<modbus::Exception> exception;  ///< empty: a value
};

/// Asks each unit for its first holding register. An exception is an answer, too, unless a gateway gives it
/// for a unit that is away (0A, 0B). A unit that stays silent costs one timeout.
std::vector<UnitAnswer> find_units(Inquiry& inquiry, Watcher& watcher,
                                   const std::vector<std::uint8_t>& units);

}  // namespace coupler::survey
