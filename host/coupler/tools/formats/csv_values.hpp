// SPDX-License-Identifier: Apache-2.0
// Cells that hold more than one number: "0..100", "1/10".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/codec/format.hpp"
#include "coupler/tools/formats/csv_headings.hpp"

namespace coupler::formats {

/// The sign of "1,000" or "1.000", which may separate thousands or decimals; '\0' if there is no such sign.
char sign_of_thousands(std::string_view number);

/// "0,5" for 0.5.
bool has_decimal_comma(std::string_view text);

/// The number as a map writes it, with a point; nullopt if it is none.
std::optional<std::string> decimal(std::string_view text);

/// The two ends of "0..100", "-40 to 85", "0 - 6553,5 V", "[0; 100]", as a map writes numbers.
struct Ends {
  std::string low;
  std::string high;
  bool comma_may_be_of_thousands = false;  ///< "1,000"
  bool point_may_be_of_thousands = false;  ///< "1.000"
};
std::optional<Ends> read_range(std::string_view text);

struct NumberAndName {
  std::string number;
  std::string name;
};
/// The values of "0=Off;1=On"; empty if the text is something else, or `values` of such a point cannot have
/// them: a name may be none, a number or name may be there twice, or the type may not hold a number.
std::vector<NumberAndName> read_names(std::string_view text, codec::Type type);

/// All that the registers of the type can hold, which says nothing about the value.
bool is_raw_range(const Ends& ends, codec::Type type);

/// The factor that a cell of a scale means, as a map writes it; the cell if it is no number.
std::string factor_text(std::string_view cell, Reading reading);

/// "-", "N/A" and the like where a number may stand.
bool says_nothing(std::string_view cell);

/// The factor that does the same; nullopt if the cell is no number, or 0.
std::optional<double> factor_of(std::string_view divisor);

}  // namespace coupler::formats
