// SPDX-License-Identifier: Apache-2.0
// A client in Python, one file on top of pymodbus.
#pragma once

#include <string>
#include <string_view>

#include "coupler/generate/generate.hpp"

namespace coupler::generate {

/// NAME_client.py: the class NAMEClient, an attribute for each point. `provenance.name` has letters, digits
/// and underscores, a letter first; words of C++ may be.
std::string python_client(const Map& map, const Provenance& provenance);

/// "HallPressClient" of "hall_press".
std::string python_class(std::string_view name);

/// The part of the file that no map changes, and what comes behind it where the coupler speaks RTU.
std::string_view python_body();
std::string_view python_rtu_body();

}  // namespace coupler::generate
