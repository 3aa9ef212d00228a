// SPDX-License-Identifier: Apache-2.0
// The output of `coupler plan`. docs/driver-reading.md lists the fields of the JSON.
#pragma once

#include <string>

#include "coupler/plan/cost.hpp"

namespace coupler::tools {

/// Tables for people.
std::string plan_text(const std::string& file, const Map& map, const plan::NetworkTiming& timing);

/// One line of JSON.
std::string plan_json(const std::string& file, const Map& map, const plan::NetworkTiming& timing);

/// A load as "12 %"; "< 0.1 %" if it would be rounded to zero.
std::string percent(double load);

}  // namespace coupler::tools
