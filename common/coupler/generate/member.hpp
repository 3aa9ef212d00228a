// SPDX-License-Identifier: Apache-2.0
// How a point looks in generated classes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "coupler/map/map.hpp"

namespace coupler::generate {

/// An identifier for each name, in their order: what identifiers cannot hold as '_', and '_' behind it as
/// often as needed to be `usable`, none of `taken`, and no other's.
std::vector<std::string> identifiers(const std::vector<std::string_view>& names,
                                     Span<const std::string_view> taken, bool (*usable)(std::string_view));

/// The names of a map's points, and of a point's values.
std::vector<std::string_view> names_of(const Map& map);
std::vector<std::string_view> names_of(const Point& point);

/// The class of a client's point: "Input", "Command", "Output".
std::string_view point_class(Access access);

/// An identifier of C++ for each point, in their order: its name, '/' as '_', and '_' behind it as often as
/// needed to be no word of C++, nothing that the client has already, and no other point's.
std::vector<std::string> members(const Map& map);

/// The same for each of its named values.
std::vector<std::string> value_names(const Point& point);

/// The C++ type of one value without its scale: "::std::int16_t".
std::string cpp_number(const Point& point);

/// The C++ type of its value: "bool", "::std::array<float, 4>" …
std::string cpp_type(const Point& point);

/// Returns the place of a point: "holding_registers 3-4", "coils 0", "holding_registers 7, bit 3".
std::string place(const Point& point);

/// Returns one line for a documentation comment: what the point is, its units, range and place.
std::string documentation(const Point& point);

}  // namespace coupler::generate
