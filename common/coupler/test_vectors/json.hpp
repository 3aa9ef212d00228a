// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "coupler/codec/value.hpp"
#include "coupler/map/map.hpp"

namespace coupler::test_vectors {

/// The cases of all points, as docs/generated.md describes them: the same bytes on every machine. `source`:
/// the map's file name, without its folder.
std::string json(const Map& map, std::string_view source, std::string_view version);

/// One value in JSON. Integers of 64 bits are texts of decimal digits; so are "nan", "inf", "-inf"; other
/// floats have as many digits as it takes to tell them from their neighbours.
std::string json(const codec::Value& value, codec::Type type);

}  // namespace coupler::test_vectors
