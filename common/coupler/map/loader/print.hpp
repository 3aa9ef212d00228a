// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/map/diagnostic.hpp"

namespace coupler {

/// Does a file descriptor lead to a person who wants colours? A terminal, and NO_COLOR (no-color.org) is not
/// set.
Colour colour_of(int descriptor);

/// All of them on standard error, for people.
void print(const Diagnostics& diagnostics);

}  // namespace coupler
