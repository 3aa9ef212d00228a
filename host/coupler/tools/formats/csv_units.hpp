// SPDX-License-Identifier: Apache-2.0
// Units that have a factor with them: "0.1V", "Hz/100", "x10".
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace coupler::formats {

/// "0.1V" is 0.1 and "V", "x10" is 10 and "", "%*10" is 10 and "%", "V/10" is 0.1 and "V".
struct FactorAndUnits {
  std::string factor;
  std::string units;
  bool is_times = false;  ///< "x10", "%*10": the register is either the value times 10, or the other way
};

/// nullopt if there is no factor, or the text is not understood.
std::optional<FactorAndUnits> read_scaled_units(std::string_view text);

/// Some number in the text is no part of a unit, as those of "m3", "s^-1", "l/100km" and "1/min" are.
bool has_number_apart(std::string_view text);

}  // namespace coupler::formats
