// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/diagnostic.hpp"

namespace coupler {

/// Does the standard error lead to a person who wants colours? A terminal, and NO_COLOR (no-color.org) is not
/// set.
Colour colour_of_stderr();

/// All of them on standard error, for people.
void print(const Diagnostics& diagnostics);

}  // namespace coupler
