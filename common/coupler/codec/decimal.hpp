// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace coupler::codec {

/// A finite number with the fewest digits that tell it from its neighbours of the same type, always with a
/// point, and with an exponent from 1e16 and below 1e-5: "0.25", "-3.0", "1.5e-7". The same text on every
/// machine; a literal of C++ and a number of JSON.
std::string decimal(double value);
std::string decimal(float value);

}  // namespace coupler::codec
