// SPDX-License-Identifier: Apache-2.0
#include "host/ros/log.hpp"

#include <cstdio>

#include <fmt/format.h>

#include "common/map/printable.hpp"

namespace coupler::driver {

void print(std::string_view text) { fmt::print(stderr, "coupler_driver: {}\n", printable_lines(text)); }

}  // namespace coupler::driver
