// SPDX-License-Identifier: Apache-2.0
// What `coupler plan` says. docs/driver.md holds the JSON's fields as a table.
#pragma once

#include <string>

#include "coupler/plan/cost.hpp"

namespace coupler::cli {

/// Tables for people.
std::string plan_text(const std::string& file, const Map& map, const plan::NetworkTiming& timing);

/// One line of JSON.
std::string plan_json(const std::string& file, const Map& map, const plan::NetworkTiming& timing);

/// "12 %": what a load is called; never "0 %" of something.
std::string percent(double load);

}  // namespace coupler::cli
