// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace coupler::scan {

/// What somebody reads on the device's display: a value that stands somewhere in its registers.
struct KnownValue {
  std::string name;  ///< of the point; may be empty
  double value = 0;
  double tolerance = 0;
};

/// "230.4", "voltage=230.4", "voltage=230.4±2" ("+-" means the same). A value without a tolerance is as exact
/// as it is written: 230.4 is 230.35 … 230.45. Errors: no number; a name that no point can have; a value that
/// may be 0, which is found everywhere.
tl::expected<KnownValue, std::string> parse_known_value(std::string_view text);

}  // namespace coupler::scan
