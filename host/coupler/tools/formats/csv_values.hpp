// SPDX-License-Identifier: Apache-2.0
// Cells that hold more than one number: "0..100", "0.1V".
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace coupler::formats {

/// "0,5" for 0.5.
bool has_decimal_comma(std::string_view text);

/// The number as a map writes it, with a point; nullopt if it is none.
std::optional<std::string> decimal(std::string_view text);

/// The two ends of "0..100", "-40 to 85", "0 - 6553,5 V", "[0; 100]", as a map writes numbers.
struct Ends {
  std::string low;
  std::string high;
};
std::optional<Ends> read_range(std::string_view text);

/// "0.1V" is 0.1 and "V", "x10" is 10 and "", "%*10" is 10 and "%".
struct FactorAndUnits {
  std::string factor;
  std::string units;
  bool is_times = false;  ///< "x10", "%*10": the register is either the value times 10, or the other way
};
std::optional<FactorAndUnits> read_scaled_units(std::string_view text);

/// The factor that does the same; nullopt if the cell is no number, or 0.
std::optional<double> factor_of(std::string_view divisor);

}  // namespace coupler::formats
