// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <fmt/format.h>

#include "coupler/cli/exit.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::cli {

/// Says "coupler COMMAND: error: WHAT; REMEDY" on standard error; returns `exit`.
inline Exit complain(std::string_view command, Exit exit, std::string_view what, std::string_view remedy) {
  fmt::print(stderr, "coupler {}: error: {}; {}\n", command, printable_lines(what), printable_lines(remedy));
  return exit;
}

}  // namespace coupler::cli
